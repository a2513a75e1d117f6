// SPDX-License-Identifier: GPL-3.0-or-later
/// An HDF5 file that is always found as of its last flush: HDF5 reads and writes it through a JournaledFile.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "map/hdf5.hpp"
#include "map/journaled_file.hpp"

namespace leapmap::hdf5 {

class File {
 public:
  File() = default;
  /// A new file, emptying an old one, in a folder made if need be: V18 format, link and attribute creation
  /// order tracked (netCDF readers need it). Throws InputError if somebody else holds it, IoError.
  static File create(const std::string& path);
  /// An existing file, read-only. Throws as create does, and BrokenFile if it is not HDF5 or not whole.
  static File open(const std::string& path);
  /// An existing file, to be changed.
  static File change(const std::string& path);
  /// A copy of a file, to be changed. Until it is closed it is blank: no journal, nothing to go on with.
  /// Throws as both of these do.
  static File copy(const std::string& from, const std::string& to);
  File(File&&) = default;
  File& operator=(File&& other) noexcept;
  /// Abandons what was not flushed.
  ~File();

  operator hid_t() const { return handle_; }
  bool is_open() const { return bytes_ != nullptr; }
  /// Brings all that was written to disk, or nothing of it. Throws IoError.
  void flush();
  /// Flushes and closes the file, which stays locked while this lives. Throws IoError.
  void close();
  /// Closes the file and gives it its name, in place of an older file if `replace`. Throws IoError.
  void finish(const std::string& path, bool replace = true);
  /// Drops what was not flushed and closes the file.
  void abandon();
  /// Abandons and removes the file.
  void discard();
  /// True if nothing was ever flushed: whoever created it was killed before that.
  static bool blank(const std::string& path);

 private:
  explicit File(std::unique_ptr<JournaledFile> bytes) : bytes_(std::move(bytes)) {}
  std::unique_ptr<JournaledFile> bytes_;
  Handle handle_;  // after bytes_, as closing it writes there
};

/// What was made before may be made again, but no other file is ours to replace: throws InputError if path is
/// there and no file of that type.
void refuse_other_file(const std::string& path, std::string_view filetype);

}  // namespace leapmap::hdf5
