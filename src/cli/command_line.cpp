// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <iostream>
#include <utility>

#include "leapmap/errors.hpp"
#include "support/number.hpp"

namespace leapmap::cli {

Check named_file() {
  return {
      [](std::string& name) { return name.empty() ? std::string("is empty; allowed: a file's name") : ""; }};
}

Check one_of(std::vector<std::string> words) {
  const std::string shown = fmt::format("{{{}}}", fmt::join(words, ","));
  return {[member = CLI::IsMember(std::move(words))](std::string& word) { return member(word); }, shown};
}

Check number(const Range& range) {
  return {[range](std::string& text) {
    const auto value = number_in(text);
    if (!value || !range.holds(*value))
      return fmt::format("'{}' is {}; allowed: {}", text, value ? "out of range" : "not a number",
                         allowed_values(range, ""));
    text = fmt::format("{}", *value);
    return std::string();
  }};
}

Check whole_number(double least, double most) {
  return {[range = Range{least, most}](std::string& text) {
    const auto value = number_in(text);
    if (!value || *value != std::floor(*value) || !range.holds(*value))
      return fmt::format("'{}' is {}; allowed: {}", text, value ? "no such number" : "not a number",
                         allowed_values(range, "", "a whole number"));
    text = fmt::format("{}", static_cast<long long>(*value));
    return std::string();
  }};
}

Flag& Flag::required() {
  option_->required();
  return *this;
}

/// CLI11's own conversion sees the value as the check wrote it.
Flag& Flag::check(const Check& check) {
  option_->transform(CLI::Validator(check.look, check.shown));
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

Flag& Flag::at_once() {
  option_->trigger_on_parse();
  return *this;
}

bool Flag::is_given() const { return option_->count() > 0; }

template <class T>
Flag Command::value(const std::string& names, T& target, const std::string& help) {
  if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    const auto add = [&target](const T& values) {
      target.insert(target.end(), values.begin(), values.end());
    };
    return Flag(app_->add_option_function<T>(names, add, help)->expected(1)->take_all());
  } else {
    return Flag(app_->add_option(names, target, help));
  }
}
template Flag Command::value(const std::string&, std::string&, const std::string&);
template Flag Command::value(const std::string&, double&, const std::string&);
template Flag Command::value(const std::string&, int&, const std::string&);
template Flag Command::value(const std::string&, std::size_t&, const std::string&);
template Flag Command::value(const std::string&, std::vector<std::string>&, const std::string&);

Flag Command::value(const std::string& names, std::function<void(const std::string&)> take,
                    const std::string& help) {
  return Flag(app_->add_option_function<std::string>(names, std::move(take), help));
}

Flag Command::flag(const std::string& names, bool& target, const std::string& help) {
  return Flag(app_->add_flag(names, target, help));
}

Flag Command::flag(const std::string& names, std::function<void()> take, const std::string& help) {
  return Flag(app_->add_flag_callback(names, std::move(take), help));
}

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::runs(std::function<void()> action) { app_->callback(std::move(action)); }

CommandLine::CommandLine(const std::string& description, const std::string& footer,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(description)) {
  app_->footer(footer);
  app_->set_version_flag("--version", version);
  app_->require_subcommand(1);
  app_->fallthrough();
}

CommandLine::~CommandLine() = default;

Command CommandLine::shared() { return Command(app_.get()); }

Command CommandLine::command(const std::string& name, const std::string& description) {
  return Command(app_->add_subcommand(name, description));
}

void CommandLine::run(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
      throw InputError(fmt::format("{} (leapmap --help, leapmap COMMAND --help)", error.what()));
    app_->exit(error);  // --help, --version
    if (!std::cout.flush()) throw IoError("standard output: cannot be written");
  }
}

}  // namespace leapmap::cli
