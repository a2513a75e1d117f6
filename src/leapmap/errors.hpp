// SPDX-License-Identifier: GPL-3.0-or-later
/// The errors a user can cause or cure, each with its exit status. One line each: file, key, value, what is
/// allowed.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace leapmap {

/// What all of them are. A text may quote what came in; a byte 0 in it is spelled out, as what() would end
/// there.
struct Error : std::runtime_error {
  explicit Error(std::string text) : std::runtime_error(without_zeros(std::move(text))) {}

 private:
  static std::string without_zeros(std::string text) {
    for (std::size_t zero; (zero = text.find('\0')) != std::string::npos;) text.replace(zero, 1, "\\x00");
    return text;
  }
};

/// Bad usage or input: exit status 2.
struct InputError : Error {
  using Error::Error;
};

/// Work ended early because its caller asked it to.
struct Stopped : Error {
  using Error::Error;
};

/// A file that cannot be read or written: exit status 3.
struct IoError : Error {
  using Error::Error;
};

/// A file that is not what it should be: an IoError that writing it anew would cure.
struct BrokenFile : IoError {
  using IoError::IoError;
};

/// A file that holds what no file of ours does: it is somebody else's, or made to deceive.
struct ForeignFile : BrokenFile {
  using BrokenFile::BrokenFile;
};

}  // namespace leapmap
