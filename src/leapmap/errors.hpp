// SPDX-License-Identifier: GPL-3.0-or-later
/// The errors a user can cause or cure, each with its exit status. One line each: file, key, value, what is
/// allowed.
#pragma once

#include <stdexcept>

namespace leapmap {

/// Bad usage or input: exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Work ended early because its caller asked it to.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written: exit status 3.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
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
