// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Exceptions that a user can cause or cure. Each message is one line: place, key, value, what is allowed.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace leapmap {

/// Base of all of leapmap's exceptions.
struct Error : std::runtime_error {
  /// A byte 0 in the text is written as \\x00, because what() would end there.
  explicit Error(std::string text) : std::runtime_error(without_zeros(std::move(text))) {}

 private:
  static std::string without_zeros(std::string text) {
    for (std::size_t zero; (zero = text.find('\0')) != std::string::npos;) text.replace(zero, 1, "\\x00");
    return text;
  }
};

/// Invalid usage or input; the program's exit status is 2.
struct InputError : Error {
  using Error::Error;
};

/// The caller asked to stop, and the work ended early.
struct Stopped : Error {
  using Error::Error;
};

/// A file cannot be read or written; the program's exit status is 3.
struct IoError : Error {
  using Error::Error;
};

/// A file is damaged. Writing it again would cure it.
struct BrokenFile : IoError {
  using IoError::IoError;
};

/// A file holds what no file of leapmap does: it comes from another program.
struct ForeignFile : BrokenFile {
  using BrokenFile::BrokenFile;
};

}  // namespace leapmap
