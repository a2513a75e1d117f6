// SPDX-License-Identifier: GPL-3.0-or-later
/// An HDF5 file that is always found as of its last flush: HDF5 reads and writes it through a JournaledFile.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "map/hdf5.hpp"
#include "map/journaled_file.hpp"

namespace leapmap::hdf5 {

class File {
 public:
  File() = default;
  /// A new file in a folder made if need be, emptying an older unfinished one of that type: format of
  /// HDF5 1.8, virtual datasets but, link and attribute creation order tracked (netCDF readers need it).
  /// Throws InputError if somebody else holds it or another file is there, IoError.
  static File create(const std::string& path, std::string_view filetype, Locking locking = Locking::required);
  /// An existing file, read-only, that holds nothing but what a file of ours may (hdf5_trust.hpp). Throws as
  /// create does, and BrokenFile if it is not HDF5 or not whole.
  static File open(const std::string& path, Locking locking = Locking::required);
  /// The same, to be changed.
  static File change(const std::string& path, Locking locking = Locking::required);
  /// A copy of a file, to be changed. Until it is closed it is blank: no journal, nothing to go on with.
  /// Throws as these do, and BrokenFile if the original has a seal and it is broken. Returns nullopt if
  /// stop_requested said so.
  static std::optional<File> copy(const JournaledFile& original, const std::string& to,
                                  std::string_view filetype, Locking locking,
                                  const std::function<bool()>& stop_requested);
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
  /// Closes the file and opens it again for `verify`, which throws if what it finds is not what was written.
  /// Commits it whatever was found, and calls `committed`. Throws what verify threw. Else seals it and gives
  /// it its name, in place of an older file if `replace`. Returns false if a power cut may undo the renaming
  /// (JournaledFile::rename). Throws IoError.
  [[nodiscard]] bool finish(
      const std::string& path, bool replace, const std::function<void(hid_t)>& verify,
      const std::function<void()>& committed = [] {});
  /// Drops what was not flushed and closes the file.
  void abandon();
  /// Abandons and removes the file.
  void discard();
  /// True if nothing was ever flushed: whoever created it was killed before that.
  static bool blank(const std::string& path, Locking locking = Locking::required);
  /// The file's bytes.
  const JournaledFile& bytes() const { return *bytes_; }

 private:
  explicit File(std::shared_ptr<JournaledFile> bytes) : bytes_(std::move(bytes)) {}
  std::shared_ptr<JournaledFile> bytes_;
  Handle handle_;  // after bytes_, as closing it writes there
};

/// Whether there is a file at path that begins as HDF5's do.
bool is_hdf5(const std::string& path, Locking locking);

/// An unfinished file is gone on with or emptied only if it is one of ours of that type, or HDF5 too damaged
/// to say what it is: throws InputError otherwise.
void refuse_other_unfinished(const std::string& path, std::string_view filetype,
                             Locking locking = Locking::required);

/// What was made before may be made again, but no other file is ours to replace: throws InputError if path is
/// there and neither empty nor a file of that type that can be read, IoError if the system fails to read it.
void refuse_other_file(const std::string& path, std::string_view filetype,
                       Locking locking = Locking::required);

}  // namespace leapmap::hdf5
