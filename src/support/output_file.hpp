// SPDX-License-Identifier: GPL-3.0-or-later
/// Where outputs go: what a name stands for, what may be replaced, and how that is done.
///
/// An output never takes the place of what a command reads, of another output, of a device, or of a file that
/// somebody else wrote. What it replaces hands on its mode and, if possible, its owner; a symbolic link stays
/// one.
#pragma once

#include <sys/stat.h>

#include <span>
#include <string>
#include <string_view>

namespace leapmap {

/// The folder that a file lies in: "." of a bare name.
std::string folder_of(const std::string& path);

/// Makes a folder and those above it, and brings the names of new ones to disk. Throws IoError.
void make_folder(const std::string& folder);

/// The file behind a symbolic link, which is to stay one; any other name as it is, and that of a device or a
/// pipe, /dev/stdout say. Throws InputError for links that form a ring.
std::string behind_links(const std::string& path);

/// Whether two names are of one file, there or not: the same name in the same folder behind all links, or the
/// same device and inode. Devices and pipes may be named twice.
bool same_file(const std::string& a, const std::string& b);

/// A path and what names it: "--csv", "SPEC". Empty paths are none.
struct NamedPath {
  std::string_view name;
  std::string path;
  bool is_map = false;  ///< HDF5, which is written as its .part, and resumed and retried beside it
};

/// Throws InputError if an output is one of the inputs, or another output.
void refuse_same_files(std::span<const NamedPath> inputs, std::span<const NamedPath> outputs);

/// Throws IoError if no file can be made beside this one, in a folder made if need be. No file is left
/// behind.
void refuse_unwritable(const std::string& path);

/// Gives a new file the mode of the one that it will replace, and its owner if the system allows that.
void take_over(int descriptor, const struct stat& replaced);

/// A text that a command writes once its work is done.
class TextOutput {
 public:
  /// Before the work: makes a temporary file beside the one to be written, or finds the device or pipe to
  /// write to. An existing file is replaced if it begins with `head`, as leapmap's own does (none: no file is
  /// known as its own), if it is empty, or with `overwrite`; a folder or an HDF5 file never. flag: what names
  /// it. An empty path is none. Throws InputError and IoError.
  TextOutput(std::string_view flag, const std::string& path, std::string_view head, bool overwrite);
  ~TextOutput();
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;

  /// Writes it, brings it to disk and gives it its name. Throws IoError: nothing is replaced then.
  void commit(std::string_view text);

 private:
  void refuse_if_changed() const;

  std::string path_, temporary_;
  int descriptor_ = -1;
  bool replaces_ = false;
  struct stat replaced_ {};
};

}  // namespace leapmap
