// SPDX-License-Identifier: GPL-3.0-or-later
/// The command line: commands with their flags, read by CLI11, which command_line.cpp alone includes, as its
/// header takes a compiler seconds.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "model/parameters.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace leapmap::cli {

struct Check {
  /// Looks at a value as it was written, which it may write in another way. Returns what is wrong with it, or
  /// nothing.
  std::function<std::string(std::string& text)> look;
  std::string shown{};  ///< the value in --help, for example "FILE"
};

/// Refuses an empty file name.
Check named_file();
/// Takes one of these words.
Check one_of(std::vector<std::string> words);
/// Takes a number in a range, or a whole one; whatever else is written is refused, NaN among it.
Check number(const Range& range);
Check whole_number(double least, double most);
inline constexpr double most_seed = 1e15;

/// A flag of a command, or a value at its place.
class Flag {
 public:
  explicit Flag(CLI::Option* option) : option_(option) {}

  Flag& required();
  Flag& check(const Check& check);
  /// May stand beside that flag only, or not beside it.
  Flag& needs(const std::string& other);
  Flag& excludes(const std::string& other);
  /// Takes several values, with commas between.
  Flag& with_commas();
  /// Takes several values, one after the other.
  Flag& several();
  /// Takes effect before the line has been read to its end.
  Flag& at_once();
  /// The value's name in --help, for example "FILE".
  Flag& shown_as(const std::string& name);
  bool is_given() const;

 private:
  CLI::Option* option_;
};

/// A command line with what it does, for --help.
struct Example {
  std::string line, meaning;
};
class Help;

/// One command. What it refers to must outlive the command line.
class Command {
 public:
  Command(CLI::App* app, Help* help) : app_(app), help_(help) {}

  /// A value, which `names` ("-o,--output") or its place ("SPEC") tell. T: std::string, double, int,
  /// std::size_t or std::vector<std::string>, to which each is added.
  template <class T>
  Flag value(const std::string& names, T& target, const std::string& help);
  Flag value(const std::string& names, std::function<void(const std::string&)> take, const std::string& help);
  /// A flag without a value.
  Flag flag(const std::string& names, bool& target, const std::string& help);
  Flag flag(const std::string& names, std::function<void()> take, const std::string& help);
  /// The heading in --help of the flags that are added from now on.
  void group(const std::string& title);
  /// Shown by --help before the flags.
  void examples(std::vector<Example> examples);
  /// Shown by --help below the flags, wrapped.
  void footer(const std::string& text) {
    footer([text] { return text; });
  }
  /// The same of a text that takes a while to write.
  void footer(std::function<std::string()> text);
  /// What the command does.
  void runs(std::function<void()> action);

 private:
  CLI::App* app_;
  Help* help_;
  std::string group_ = "Options";
};

class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& version);
  ~CommandLine();

  /// What all commands share: its flags may stand before and after a command's name.
  Command shared();
  Command command(const std::string& name, const std::string& description);
  /// Reads the line and runs its command, or prints the help or the version that it asks for. Throws
  /// InputError, and what the command throws.
  void run(int argc, char** argv);

 private:
  std::shared_ptr<Help> help_;
  std::unique_ptr<CLI::App> app_;
};

}  // namespace leapmap::cli
