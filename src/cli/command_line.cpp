// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <utility>

#include "leapmap/errors.hpp"
#include "spec/options.hpp"
#include "support/closest.hpp"
#include "support/number.hpp"
#include "support/wrapped.hpp"

namespace leapmap::cli {

/// Writes --help: what the command does, how it is called, examples, flags by group, notes.
class Help final : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
    const CLI::App* parent = app->get_parent();
    const std::string name = parent ? parent->get_name() + " " + app->get_name() : app->get_name();
    std::string text = wrapped(name + ": " + app->get_description());
    text += "\nUsage: " + name + usage_of(app) + "\n";
    if (const auto found = examples.find(app); found != examples.end()) {
      text += "\nExamples:\n";
      for (const Example& example : found->second)
        text += "  " + example.line + "\n" + list_entry("", example.meaning, 6);
    }
    text += commands_of(app);
    text += list_of(app, "Arguments", [](const CLI::Option* option) { return option->get_positional(); });
    for (const std::string& group : app->get_groups())
      text += list_of(app, group, [&](const CLI::Option* option) {
        return option->nonpositional() && option->get_group() == group;
      });
    if (const auto found = footers.find(app); found != footers.end()) text += "\n" + wrapped(found->second());
    return text;
  }

  std::map<const CLI::App*, std::vector<Example>> examples;
  std::map<const CLI::App*, std::function<std::string()>> footers;

 private:
  static constexpr std::size_t column = 26;

  static std::string usage_of(const CLI::App* app) {
    if (!app->get_subcommands({}).empty()) return " COMMAND [options]";
    std::string usage;
    for (const CLI::Option* option : app->get_options())
      if (option->get_positional())
        usage += option->get_required() ? " " + option->get_name(true) : " [" + option->get_name(true) + "]";
    return usage + " [options]";
  }

  static std::string commands_of(const CLI::App* app) {
    std::string text;
    for (const CLI::App* command : app->get_subcommands({})) {
      if (text.empty()) text = "\nCommands:\n";
      text += list_entry("  " + command->get_name(), command->get_description(), 14);
    }
    return text;
  }

  template <class Belongs>
  static std::string list_of(const CLI::App* app, const std::string& title, const Belongs& belongs) {
    std::string text;
    for (const CLI::Option* option : app->get_options()) {
      if (!belongs(option)) continue;
      if (text.empty()) text = "\n" + title + ":\n";
      std::string name = "  ";
      if (option->get_positional()) {
        name += option->get_name(true);
      } else {
        for (const std::string& letter : option->get_snames()) name += "-" + letter + ", ";
        for (const std::string& word : option->get_lnames()) name += "--" + word;
        if (option->get_items_expected_max() > 0) name += " " + option->get_type_name();
      }
      text += list_entry(name, option->get_description(), column);
    }
    return text;
  }
};

namespace {

/// What is wrong with the words that no command or flag of ours takes.
std::string unknown_words(const CLI::App& app) {
  const std::vector<CLI::App*> commands = app.get_subcommands();
  const CLI::App* command = commands.empty() ? &app : commands.front();
  const std::vector<std::string> words = app.remaining(true);
  if (words.empty()) return {};
  std::vector<std::string> names;
  const bool is_flag = words[0].starts_with("-");
  const std::string word = words[0].substr(0, words[0].find('='));
  if (is_flag) {
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  } else if (command == &app) {
    for (const CLI::App* one : app.get_subcommands({})) names.push_back(one->get_name());
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  const std::string suggestion = did_you_mean(word, candidates);
  if (command != &app && is_flag && suggestion.empty() && command->get_option_no_throw("--set"))
    if (std::string key = word.substr(2); std::ranges::replace(key, '-', '_'), find_option("", key))
      return fmt::format("{}: unknown option; allowed: --set {}=...", word, key);
  if (command != &app)
    return fmt::format("{}: unknown {}{} (leapmap {} --help)", word, is_flag ? "option" : "argument",
                       suggestion, command->get_name());
  if (is_flag) return fmt::format("{}: unknown option{} (leapmap --help)", word, suggestion);
  return fmt::format("{}: unknown command{}; allowed: {}", word, suggestion, fmt::join(names, ", "));
}

/// "--hoop.slug.mass 85g" as "--set hoop.slug.mass=85g", for commands that take --set: a spec says which
/// weights there are.
std::vector<std::string> with_hoop_keys(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
  const auto command = std::ranges::find_first_of(words, commands, {}, {}, &CLI::App::get_name);
  const bool takes_set = command != words.end() && std::ranges::any_of(commands, [&](const CLI::App* one) {
                           return one->get_name() == *command && one->get_option_no_throw("--set");
                         });
  if (!takes_set) return words;
  std::vector<std::string> read;
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (!word->starts_with("--hoop.")) {
      read.push_back(*word);
      continue;
    }
    std::string set = word->substr(2);
    if (set.find('=') == std::string::npos) {
      if (word + 1 == words.end())
        throw InputError(
            fmt::format("{}: lacks its value; allowed: {} VALUE, for example {} 85g", *word, *word, *word));
      set += "=" + *++word;
    }
    read.insert(read.end(), {"--set", std::move(set)});
  }
  return read;
}

}  // namespace

Check named_file() {
  return {
      [](std::string& name) { return name.empty() ? std::string("is empty; allowed: a file's name") : ""; },
      "FILE"};
}

Check one_of(std::vector<std::string> words) {
  const std::string shown = words.size() > 3 ? "WORD" : fmt::format("{}", fmt::join(words, "|"));
  return {[words = std::move(words)](std::string& word) {
            if (std::ranges::find(words, word) != words.end()) return std::string();
            const std::vector<std::string_view> candidates(words.begin(), words.end());
            return fmt::format("'{}' is unknown{}; allowed: {}", word, did_you_mean(word, candidates),
                               fmt::join(words, ", "));
          },
          shown};
}

Check number(const Range& range) {
  return {[range](std::string& text) {
            const auto value = number_in(text);
            if (!value || !range.holds(*value))
              return fmt::format("'{}' is {}; allowed: {}", text, value ? "out of range" : "not a number",
                                 allowed_values(range, ""));
            text = fmt::format("{}", *value);
            return std::string();
          },
          "NUMBER"};
}

Check whole_number(double least, double most) {
  return {[range = Range{least, most}](std::string& text) {
            const auto value = number_in(text);
            if (!value || *value != std::floor(*value) || !range.holds(*value))
              return fmt::format("'{}' is {}; allowed: {}", text, value ? "no such number" : "not a number",
                                 allowed_values(range, "", "a whole number"));
            text = fmt::format("{}", static_cast<long long>(*value));
            return std::string();
          },
          "COUNT"};
}

Flag& Flag::required() {
  option_->required();
  return *this;
}

/// CLI11's own conversion sees the value as the check wrote it.
Flag& Flag::check(const Check& check) {
  option_->transform(CLI::Validator(check.look, ""));
  if (!check.shown.empty()) option_->type_name(check.shown);
  return *this;
}

Flag& Flag::needs(const std::string& other) {
  option_->needs(other);
  return *this;
}

Flag& Flag::excludes(const std::string& other) {
  option_->excludes(other);
  return *this;
}

Flag& Flag::with_commas() {
  option_->expected(1, CLI::detail::expected_max_vector_size)->delimiter(',');
  return *this;
}

Flag& Flag::several() {
  option_->expected(1, CLI::detail::expected_max_vector_size);
  return *this;
}

Flag& Flag::at_once() {
  option_->trigger_on_parse();
  return *this;
}

Flag& Flag::shown_as(const std::string& name) {
  option_->type_name(name);
  return *this;
}

bool Flag::is_given() const { return option_->count() > 0; }

template <class T>
Flag Command::value(const std::string& names, T& target, const std::string& help) {
  if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    const auto add = [&target](const T& values) {
      target.insert(target.end(), values.begin(), values.end());
    };
    return Flag(app_->add_option_function<T>(names, add, help)->expected(1)->take_all()->group(group_));
  } else {
    return Flag(app_->add_option(names, target, help)->group(group_));
  }
}
template Flag Command::value(const std::string&, std::string&, const std::string&);
template Flag Command::value(const std::string&, double&, const std::string&);
template Flag Command::value(const std::string&, int&, const std::string&);
template Flag Command::value(const std::string&, std::size_t&, const std::string&);
template Flag Command::value(const std::string&, std::vector<std::string>&, const std::string&);

Flag Command::value(const std::string& names, std::function<void(const std::string&)> take,
                    const std::string& help) {
  return Flag(app_->add_option_function<std::string>(names, std::move(take), help)->group(group_));
}

Flag Command::flag(const std::string& names, bool& target, const std::string& help) {
  return Flag(app_->add_flag(names, target, help)->group(group_));
}

Flag Command::flag(const std::string& names, std::function<void()> take, const std::string& help) {
  return Flag(app_->add_flag_callback(names, std::move(take), help)->group(group_));
}

void Command::group(const std::string& title) { group_ = title; }

void Command::examples(std::vector<Example> examples) { help_->examples[app_] = std::move(examples); }

void Command::footer(std::function<std::string()> text) { help_->footers[app_] = std::move(text); }

void Command::runs(std::function<void()> action) { app_->callback(std::move(action)); }

CommandLine::CommandLine(const std::string& description, const std::string& version)
    : help_(std::make_shared<Help>()), app_(std::make_unique<CLI::App>(description, "leapmap")) {
  app_->formatter(help_);
  app_->set_help_flag("-h,--help", "print this help");
  app_->set_version_flag("--version", version, "print version, git revision and instruction set");
  app_->require_subcommand(1);
  app_->fallthrough();
}

CommandLine::~CommandLine() = default;

Command CommandLine::shared() { return Command(app_.get(), help_.get()); }

Command CommandLine::command(const std::string& name, const std::string& description) {
  CLI::App* command = app_->add_subcommand(name, description);
  command->set_help_flag("-h,--help", "print this help");
  return Command(command, help_.get());
}

void CommandLine::run(int argc, char** argv) {
  try {
    std::vector<std::string> words = with_hoop_keys(*app_, {argv + 1, argv + argc});
    std::ranges::reverse(words);  // as CLI11 takes them
    app_->parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
      const std::string unknown = unknown_words(*app_);
      throw InputError(!unknown.empty()
                           ? unknown
                           : fmt::format("{} (leapmap --help, leapmap COMMAND --help)", error.what()));
    }
    app_->exit(error);  // --help, --version
    if (!std::cout.flush()) throw IoError("standard output: cannot be written");
  }
}

}  // namespace leapmap::cli
