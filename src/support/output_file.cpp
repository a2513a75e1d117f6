// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "leapmap/errors.hpp"
#include "support/file_calls.hpp"
#include "support/posix.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;

/// Where a device, a pipe, or what standard output is turned to is named, links are the system's own.
bool is_stream(const struct stat& status) {
  return S_ISCHR(status.st_mode) || S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode);
}

/// The descriptor of ours, standard output or error, that already writes to a file; -1: neither.
int own_descriptor(const struct stat& status) {
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
    if (struct stat own{};
        ::fstat(descriptor, &own) == 0 && own.st_dev == status.st_dev && own.st_ino == status.st_ino)
      return descriptor;
  return -1;
}

/// A new file beside `path`, of a name that nothing has.
int create_beside(const std::string& path, std::string& name) {
  constexpr int most_trials = 100;
  for (int trial = 0; trial < most_trials; ++trial) {
    name = fmt::format("{}.{}-{}.new", path, ::getpid(), trial);
    const int descriptor = uninterrupted(
        [&] { return ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666); });
    if (descriptor >= 0) return descriptor;
    if (errno != EEXIST) break;
  }
  fail_with_errno(path, "cannot be written");
}

/// What an existing file begins with.
std::string first_bytes(const std::string& path, std::size_t count) {
  std::string head(count, '\0');
  const int descriptor = uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); });
  if (descriptor < 0) return {};  // not to be read, so that nobody knows whose it is
  const ssize_t read = uninterrupted([&] { return ::pread(descriptor, head.data(), count, 0); });
  ::close(descriptor);
  head.resize(read > 0 ? static_cast<std::size_t>(read) : 0);
  return head;
}

}  // namespace

std::string folder_of(const std::string& path) {
  const std::string parent = fs::path(path).parent_path();
  return parent.empty() ? "." : parent;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> parents;  // of what is new
  for (fs::path made = folder; !made.empty() && !fs::exists(made, error); made = made.parent_path())
    parents.push_back(folder_of(made.string()));
  fs::create_directories(folder, error);
  if (error) throw IoError(fmt::format("{}: cannot be created: {}", folder, error.message()));
  for (const std::string& parent : parents)
    if (!sync_folder(parent)) throw IoError(folder + ": cannot be synced to disk");
}

std::string behind_links(const std::string& name) {
  constexpr int most_links = 40;  // as the kernel
  if (struct stat status{}; ::stat(name.c_str(), &status) == 0 && is_stream(status)) return name;
  fs::path path = name;
  std::error_code error;
  for (int i = 0; fs::is_symlink(path, error); ++i) {
    if (i == most_links) throw InputError(name + ": is a cycle of symbolic links; allowed: a file's name");
    path = path.parent_path() / fs::read_symlink(path, error);
  }
  return path.string();
}

bool same_file(const std::string& a, const std::string& b) {
  const fs::path first = behind_links(a), second = behind_links(b);
  std::error_code error;
  if (const auto there = fs::status(first, error); fs::exists(there)) {
    if (!fs::is_regular_file(there) && !fs::is_directory(there)) return false;
    if (fs::equivalent(first, second, error)) return true;
  }
  if (first.filename() != second.filename()) return false;
  const fs::path folder = folder_of(first.string()), other = folder_of(second.string());
  return fs::equivalent(folder, other, error) ||
         fs::weakly_canonical(folder, error) == fs::weakly_canonical(other, error);
}

void refuse_same_files(std::span<const NamedPath> inputs, std::span<const NamedPath> outputs) {
  const auto written = [](const NamedPath& output) {
    const std::string path = behind_links(output.path);
    return output.is_map ? std::vector<std::string>{path, path + ".part", path + ".retry"}
                         : std::vector<std::string>{path};
  };
  for (const NamedPath& output : outputs) {
    if (output.path.empty()) continue;
    for (const std::string& path : written(output)) {
      for (const NamedPath& input : inputs)
        if (!input.path.empty() && same_file(path, input.path))
          throw InputError(fmt::format("{} {}: is the same file as {} {}; allowed: another name", output.name,
                                       path, input.name, input.path));
      for (const NamedPath& other : outputs) {
        if (&other == &output || other.path.empty()) continue;
        for (const std::string& also : written(other))
          if (same_file(path, also))
            throw InputError(fmt::format("{} {}: is the same file as {} {}; allowed: another name",
                                         output.name, output.path, other.name, other.path));
      }
    }
  }
}

void refuse_unwritable(const std::string& path) {
  const std::string file = behind_links(path);
  make_folder(folder_of(file));
  std::string name;
  const int descriptor = create_beside(file, name);
  ::unlink(name.c_str());
  ::close(descriptor);
}

void take_over(int descriptor, const struct stat& replaced) {
  mode_t mode = replaced.st_mode & mode_t{0777};
  // Who may not give a file away keeps it; its group, which may be another then, gets no rights.
  if (::fchown(descriptor, replaced.st_uid, replaced.st_gid) != 0 &&
      ::fchown(descriptor, static_cast<uid_t>(-1), replaced.st_gid) != 0)
    mode &= ~mode_t{070};
  static_cast<void>(::fchmod(descriptor, mode) != 0);  // some file systems have no modes
}

TextOutput::TextOutput(std::string_view flag, const std::string& path, std::string_view head,
                       bool overwrite) {
  if (path.empty()) return;
  path_ = behind_links(path);
  if (::stat(path_.c_str(), &replaced_) == 0) {
    if (is_stream(replaced_) || own_descriptor(replaced_) >= 0) return;  // opened when there is something
    if (!S_ISREG(replaced_.st_mode))
      throw InputError(fmt::format("{} {}: is not a file; allowed: a file's name", flag, path));
    replaces_ = true;
    constexpr std::string_view hdf5 = "\x89HDF";
    const std::string there = first_bytes(path_, std::max(head.size(), hdf5.size()));
    if (there.starts_with(hdf5))
      throw InputError(fmt::format("{} {}: is an HDF5 file; allowed: another name", flag, path));
    if (!overwrite && replaced_.st_size > 0 && (head.empty() || !there.starts_with(head)))
      throw InputError(
          fmt::format("{} {}: exists and was not written by leapmap; allowed: another name, or "
                      "--overwrite",
                      flag, path));
  }
  descriptor_ = create_beside(path_, temporary_);
}

TextOutput::~TextOutput() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void TextOutput::commit(std::string_view text) {
  if (path_.empty()) return;
  if (temporary_.empty()) {
    std::fflush(stdout);  // what was printed comes first
    const int own = own_descriptor(replaced_);
    descriptor_ = own >= 0
                      ? ::fcntl(own, F_DUPFD_CLOEXEC, 0)
                      : uninterrupted([&] { return ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY); });
    if (descriptor_ < 0) fail_with_errno(path_, "cannot be written");
    write_stream(descriptor_, path_, text);
    return;
  }
  write_all(descriptor_, path_, 0, std::as_bytes(std::span(text)));
  if (replaces_) take_over(descriptor_, replaced_);
  sync(descriptor_, path_);
  refuse_if_changed();
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail_with_errno(path_, "cannot be given its name");
  temporary_.clear();
  sync_folder(folder_of(path_));  // the file is in its place either way
}

/// The work may have taken minutes: what has that name now is what was there before, or nothing.
void TextOutput::refuse_if_changed() const {
  struct stat now {};
  const bool there = ::stat(path_.c_str(), &now) == 0;
  const bool same = there && replaces_ && now.st_dev == replaced_.st_dev && now.st_ino == replaced_.st_ino &&
                    now.st_size == replaced_.st_size && now.st_mtim.tv_sec == replaced_.st_mtim.tv_sec &&
                    now.st_mtim.tv_nsec == replaced_.st_mtim.tv_nsec;
  if (there && !same) throw IoError(path_ + ": another program has written it; allowed: another name");
}

}  // namespace leapmap
