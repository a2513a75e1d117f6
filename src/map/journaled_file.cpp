// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/journaled_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "support/errors.hpp"

namespace leapmap {
namespace {

constexpr std::uint64_t signature_bytes = 8;

/// Ends a journal, and the file that has one. Before it: each write as offset, length and bytes.
struct Footer {
  std::array<char, 16> magic{'l', 'e', 'a', 'p', 'm', 'a', 'p', ' ', 'j', 'o', 'u', 'r', 'n', 'a', 'l', '\n'};
  std::uint64_t begin = 0;  ///< of the journal in the file
  std::uint64_t size = 0;   ///< of the file once the writes are made
  std::uint32_t reserved = 0;
  std::uint32_t checksum = 0;  ///< CRC-32 of the journal up to here
};
static_assert(sizeof(Footer) == 40);

[[noreturn]] void fail(const std::string& path, std::string_view what) {
  const int reason = errno;
  throw IoError(fmt::format("{}: {}: {}", path, what, std::strerror(reason)));
}

void sync(int descriptor, const std::string& path) {
  if (::fsync(descriptor) != 0) fail(path, "cannot be brought to disk");
}

/// Brings a file's name to disk. Nothing is to be done if that cannot be: the name is there all the same.
void sync_folder(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::uint64_t size_on_disk(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail(path, "cannot be read");
  return static_cast<std::uint64_t>(status.st_size);
}

/// False at the end of the file.
bool read_all(int descriptor, const std::string& path, std::uint64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "cannot be read");
    if (count == 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
  return true;
}

void write_all(int descriptor, const std::string& path, std::uint64_t offset,
               std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

std::uint32_t checksum_of(std::span<const std::byte> journal) {
  return libdeflate_crc32(0, journal.data(), journal.size() - sizeof(Footer::checksum));
}

}  // namespace

JournaledFile::JournaledFile(const std::string& path, Access access) : path_(path), access_(access) {
  const int flags = access == Access::read     ? O_RDONLY
                    : access == Access::change ? O_RDWR | O_NOFOLLOW
                                               : O_RDWR | O_NOFOLLOW | O_CREAT;
  descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(path, access == Access::create ? "cannot be created" : "cannot be opened");
  try {
    lock();
    if (access == Access::create) {
      if (::ftruncate(descriptor_, 0) != 0) fail(path, "cannot be created");
    } else {
      committed_ = stored_ = size_on_disk(descriptor_, path);
      read_journal();
      size_ = committed_;
      if (access == Access::change && journal_valid_) make_waiting_writes();
    }
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

JournaledFile::~JournaledFile() {
  abandon();
  ::close(descriptor_);
}

void JournaledFile::lock() const {
  const bool reads = access_ == Access::read;
  const bool unlocked = ::flock(descriptor_, (reads ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0;
  const bool busy = unlocked && errno == EWOULDBLOCK;  // any other reason: the file system knows no locks
  struct stat opened {
  }, named{};
  const bool same = ::fstat(descriptor_, &opened) == 0 && ::stat(path_.c_str(), &named) == 0 &&
                    opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
  if (busy || !same)  // not the same: renamed by whoever held it, between our opening and our locking
    throw InputError(fmt::format("{}: another program is {} it; allowed: once that has ended", path_,
                                 reads ? "writing" : "using"));
}

void JournaledFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  const std::uint64_t end = offset + bytes.size();
  std::ranges::fill(bytes, std::byte{0});
  if (offset < stored_)
    read_all(descriptor_, path_, offset,
             bytes.first(std::min<std::uint64_t>(bytes.size(), stored_ - offset)));
  for (const Write& write : waiting_) {
    const std::uint64_t first = std::max(offset, write.offset),
                        last = std::min(end, write.offset + write.bytes.size());
    if (first < last)
      std::memcpy(bytes.data() + (first - offset), write.bytes.data() + (first - write.offset), last - first);
  }
}

void JournaledFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (abandoned_) return;
  const std::uint64_t guarded = std::max(committed_, signature_bytes);
  if (offset < guarded) {
    const auto waits = bytes.first(std::min<std::uint64_t>(bytes.size(), guarded - offset));
    waiting_.push_back({offset, {waits.begin(), waits.end()}});
    bytes = bytes.subspan(waits.size());
    offset += waits.size();
  }
  if (bytes.empty()) return;
  write_all(descriptor_, path_, offset, bytes);
  stored_ = std::max(stored_, offset + bytes.size());
}

void JournaledFile::commit() {
  if (abandoned_) return;
  sync(descriptor_, path_);  // what was appended has to be there before anything refers to it
  const bool first = committed_ == 0;
  if (!waiting_.empty()) {
    write_journal();
    journal_valid_ = true;
  }
  committed_ = size_;
  make_waiting_writes();
  if (first) sync_folder(path_);  // else a power cut may take the file's name away
}

void JournaledFile::write_journal() {
  const Footer footer{.begin = std::max(size_, stored_), .size = size_};
  std::vector<std::byte> journal;
  for (const Write& write : waiting_) {
    append(journal, write.offset);
    append(journal, std::uint64_t{write.bytes.size()});
    journal.insert(journal.end(), write.bytes.begin(), write.bytes.end());
  }
  append(journal, footer);
  const std::uint32_t checksum = checksum_of(journal);
  std::memcpy(journal.data() + journal.size() - sizeof checksum, &checksum, sizeof checksum);
  write_all(descriptor_, path_, footer.begin, journal);
  sync(descriptor_, path_);
}

void JournaledFile::make_waiting_writes() {
  for (const Write& write : waiting_) write_all(descriptor_, path_, write.offset, write.bytes);
  if (!waiting_.empty()) sync(descriptor_, path_);
  if (::ftruncate(descriptor_, static_cast<off_t>(committed_)) != 0) fail(path_, "cannot be written");
  journal_valid_ = false;
  waiting_.clear();
  stored_ = committed_;
}

void JournaledFile::read_journal() {
  Footer footer;
  if (stored_ < sizeof footer) return;
  read_all(descriptor_, path_, stored_ - sizeof footer, std::as_writable_bytes(std::span(&footer, 1)));
  if (footer.magic != Footer{}.magic || footer.begin > stored_ - sizeof footer) return;
  std::vector<std::byte> journal(stored_ - footer.begin);
  read_all(descriptor_, path_, footer.begin, journal);
  if (checksum_of(journal) != footer.checksum) return;
  const std::byte* next = journal.data();
  const std::byte* const last = journal.data() + journal.size() - sizeof footer;
  while (next < last) {  // whole, by its checksum, and so written by us
    std::array<std::uint64_t, 2> head{};
    std::memcpy(head.data(), next, sizeof head);
    next += sizeof head;
    waiting_.push_back({head[0], {next, next + head[1]}});
    next += head[1];
  }
  journal_valid_ = true;
  committed_ = footer.size;
  stored_ = footer.begin;
}

void JournaledFile::abandon() {
  if (abandoned_ || access_ == Access::read) return;
  abandoned_ = true;
  // Gives the space back; if it cannot, what lies beyond the committed end is ignored all the same.
  if (!journal_valid_) static_cast<void>(::ftruncate(descriptor_, static_cast<off_t>(committed_)) != 0);
}

void JournaledFile::rename(const std::string& path, bool replace) {
  int failed = -1;
  if (!replace) failed = ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  const bool unknown = !replace && failed != 0 && (errno == EINVAL || errno == ENOSYS);  // to the file system
  if (replace || unknown) failed = std::rename(path_.c_str(), path.c_str());
  if (failed != 0) fail(path, "cannot be given its name");
  path_ = path;
  sync_folder(path);
}

std::uint64_t JournaledFile::end() const {
  std::uint64_t end = stored_;
  for (const Write& write : waiting_) end = std::max<std::uint64_t>(end, write.offset + write.bytes.size());
  return end;
}

bool JournaledFile::blank() const {
  std::array<std::byte, signature_bytes> first{};
  read(0, first);
  return std::ranges::all_of(first, [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace leapmap
