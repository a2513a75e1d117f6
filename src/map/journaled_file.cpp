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
#include "support/posix.hpp"

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

/// Ends a file that is whole. Its checksum is of all bytes before that number.
struct Seal {
  std::array<char, 16> magic{'l', 'e', 'a', 'p', 'm', 'a', 'p', ' ', 'c', 'h', 'e', 'c', 'k', 's', 'u', 'm'};
  std::uint64_t size = 0;  ///< of the file before the seal
  std::uint32_t reserved = 0;
  std::uint32_t checksum = 0;  ///< CRC-32
};
static_assert(sizeof(Seal) == 32);

void sync(int descriptor, const std::string& path) {
  if (uninterrupted([&] { return ::fsync(descriptor); }) != 0)
    fail_with_errno(path, "cannot be brought to disk");
}

void cut(int descriptor, const std::string& path, std::uint64_t size) {
  if (uninterrupted([&] { return ::ftruncate(descriptor, static_cast<off_t>(size)); }) != 0)
    fail_with_errno(path, "cannot be written");
}

std::string folder_of(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent;
}

struct stat status_of(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail_with_errno(path, "cannot be read");
  return status;
}

/// Throws IoError if the file ends before.
void read_all(int descriptor, const std::string& path, std::uint64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = uninterrupted(
        [&] { return ::pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset)); });
    if (count < 0) fail_with_errno(path, "cannot be read");
    if (count == 0) throw IoError(path + ": cannot be read: it ends too early");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void write_all(int descriptor, const std::string& path, std::uint64_t offset,
               std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = uninterrupted(
        [&] { return ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset)); });
    if (count < 0) fail_with_errno(path, "cannot be written");
    if (count == 0) throw IoError(path + ": cannot be written: the system takes no bytes");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

/// CRC-32 of a stretch of the file, going on from `sum`.
std::uint32_t checksum_of(int descriptor, const std::string& path, std::uint64_t begin, std::uint64_t end,
                          std::uint32_t sum = 0) {
  std::vector<std::byte> block(std::min<std::uint64_t>(std::size_t{1} << 18, end - begin));
  for (std::uint64_t offset = begin; offset < end; offset += block.size()) {
    block.resize(std::min<std::uint64_t>(block.size(), end - offset));
    read_all(descriptor, path, offset, block);
    sum = libdeflate_crc32(sum, block.data(), block.size());
  }
  return sum;
}

std::uint32_t checksum_of(int descriptor, const std::string& path, const Seal& seal) {
  return libdeflate_crc32(checksum_of(descriptor, path, 0, seal.size), &seal, offsetof(Seal, checksum));
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

}  // namespace

template <class F>
void JournaledFile::attempt(const F& f) const {
  rethrow_failure();
  try {
    f();
  } catch (const std::exception& error) {
    failed_ = true;
    failure_ = error.what();
    throw;
  }
}

void JournaledFile::rethrow_failure() const {
  if (failed_) throw IoError(failure_.empty() ? path_ + ": failed before" : failure_);
}

JournaledFile::JournaledFile(const std::string& path, Access access, Locking locking)
    : path_(path), access_(access) {
  const int flags = access == Access::read     ? O_RDONLY
                    : access == Access::change ? O_RDWR | O_NOFOLLOW
                                               : O_RDWR | O_NOFOLLOW | O_CREAT;
  // Not blocking: to open a pipe would wait for whoever writes to it.
  descriptor_ = uninterrupted([&] { return ::open(path.c_str(), flags | O_NONBLOCK | O_CLOEXEC, 0666); });
  if (descriptor_ < 0)
    fail_with_errno(path, access == Access::create ? "cannot be created" : "cannot be opened");
  try {
    open(locking);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

void JournaledFile::open(Locking locking) {
  if (!S_ISREG(status_of(descriptor_, path_).st_mode))
    throw InputError(path_ + ": is a device, a pipe or a folder; allowed: a file");
  lock(locking);
  if (access_ == Access::create) return cut(descriptor_, path_, 0);
  committed_ = stored_ = static_cast<std::uint64_t>(status_of(descriptor_, path_).st_size);
  read_seal();
  if (!seal_) read_journal();
  size_ = committed_;
  if (access_ == Access::change && journal_valid_) make_waiting_writes();
}

JournaledFile::~JournaledFile() {
  abandon();
  ::close(descriptor_);  // can lose nothing: what was committed was synced
}

bool JournaledFile::is_named(const std::string& path) const {
  const struct stat opened = status_of(descriptor_, path_);
  struct stat named {};
  if (::stat(path.c_str(), &named) != 0) {
    if (errno == ENOENT) return false;
    fail_with_errno(path, "cannot be looked at");
  }
  return opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

void JournaledFile::lock(Locking locking) const {
  const bool reads = access_ == Access::read;
  const bool locked =
      uninterrupted([&] { return ::flock(descriptor_, (reads ? LOCK_SH : LOCK_EX) | LOCK_NB); }) == 0;
  const bool busy = !locked && errno == EWOULDBLOCK;
  if (!locked && !busy && locking == Locking::required)
    throw IoError(
        fmt::format("{}: cannot be locked: {}; allowed: a file system with locks, or --no-lock if no other "
                    "program uses it",
                    path_, std::strerror(errno)));
  if (busy ||
      !is_named(path_))  // the latter: renamed by whoever held it, between our opening and our locking
    throw InputError(fmt::format("{}: a sweep or another program is {} it; allowed: once that has ended",
                                 path_, reads ? "writing" : "using"));
}

void JournaledFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  attempt([&] {
    const std::uint64_t end = offset + bytes.size();
    const std::size_t there = offset < stored_ ? std::min<std::uint64_t>(bytes.size(), stored_ - offset) : 0;
    read_all(descriptor_, path_, offset, bytes.first(there));
    std::ranges::fill(bytes.subspan(there), std::byte{0});
    for (const Write& write : waiting_) {
      const std::uint64_t first = std::max(offset, write.offset),
                          last = std::min(end, write.offset + write.bytes.size());
      if (first < last)
        std::memcpy(bytes.data() + (first - offset), write.bytes.data() + (first - write.offset),
                    last - first);
    }
  });
}

void JournaledFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (abandoned_) return;
  attempt([&] {
    const std::uint64_t guarded = std::max(committed_, signature_bytes);
    if (offset < guarded) {
      const auto waits = bytes.first(std::min<std::uint64_t>(bytes.size(), guarded - offset));
      waiting_.push_back({offset, {waits.begin(), waits.end()}});
      bytes = bytes.subspan(waits.size());
      offset += waits.size();
    }
    if (bytes.empty()) return;
    seal_.reset();  // it is overwritten
    write_all(descriptor_, path_, offset, bytes);
    stored_ = std::max(stored_, offset + bytes.size());
  });
}

void JournaledFile::commit() {
  if (abandoned_) return;
  attempt([&] {
    sync(descriptor_, path_);  // what was appended has to be there before anything refers to it
    const bool first = committed_ == 0;
    if (!waiting_.empty()) {
      write_journal();
      journal_valid_ = true;
    }
    committed_ = size_;
    make_waiting_writes();
    if (first && !sync_folder(folder_of(path_)))
      throw IoError(path_ + ": its folder cannot be brought to disk");
  });
}

void JournaledFile::seal() {
  if (abandoned_) return;
  attempt([&] {
    Seal seal{.size = committed_};
    seal.checksum = checksum_of(descriptor_, path_, seal);
    write_all(descriptor_, path_, committed_, std::as_bytes(std::span(&seal, 1)));
    sync(descriptor_, path_);
    seal_ = seal.checksum;
  });
}

std::optional<bool> JournaledFile::seal_holds() const {
  if (!seal_) return std::nullopt;
  return checksum_of(descriptor_, path_, Seal{.size = committed_}) == *seal_;
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
  const std::uint32_t checksum =
      libdeflate_crc32(0, journal.data(), journal.size() - sizeof(Footer::checksum));
  std::memcpy(journal.data() + journal.size() - sizeof checksum, &checksum, sizeof checksum);
  write_all(descriptor_, path_, footer.begin, journal);
  sync(descriptor_, path_);
}

void JournaledFile::make_waiting_writes() {
  for (const Write& write : waiting_) write_all(descriptor_, path_, write.offset, write.bytes);
  if (!waiting_.empty()) sync(descriptor_, path_);
  cut(descriptor_, path_, committed_);
  seal_.reset();
  journal_valid_ = false;
  waiting_.clear();
  stored_ = committed_;
}

void JournaledFile::read_journal() {
  // Of changed metadata between two commits.
  constexpr std::uint64_t most = std::uint64_t{1} << 30;
  constexpr std::size_t most_writes = 1'000'000;
  Footer footer;
  if (stored_ < sizeof footer) return;
  read_all(descriptor_, path_, stored_ - sizeof footer, std::as_writable_bytes(std::span(&footer, 1)));
  if (footer.magic != Footer{}.magic || footer.begin > stored_ - sizeof footer) return;
  if (checksum_of(descriptor_, path_, footer.begin, stored_ - sizeof(Footer::checksum)) != footer.checksum)
    return;
  const auto refuse_unless = [&](bool sense) {
    if (!sense) throw BrokenFile(path_ + ": is damaged: its journal makes no sense");
  };
  refuse_unless(footer.size <= footer.begin && stored_ - footer.begin <= most);
  std::vector<std::byte> journal(stored_ - sizeof footer - footer.begin);
  read_all(descriptor_, path_, footer.begin, journal);
  for (std::span<const std::byte> left = journal; !left.empty();) {
    std::array<std::uint64_t, 2> head{};  // offset, length
    refuse_unless(left.size() >= sizeof head);
    std::memcpy(head.data(), left.data(), sizeof head);
    left = left.subspan(sizeof head);
    refuse_unless(head[1] > 0 && waiting_.size() < most_writes && head[1] <= left.size() &&
                  head[0] <= footer.begin && head[1] <= footer.begin - head[0]);
    waiting_.push_back({head[0], {left.begin(), left.begin() + static_cast<std::ptrdiff_t>(head[1])}});
    left = left.subspan(head[1]);
  }
  journal_valid_ = true;
  committed_ = footer.size;
  stored_ = footer.begin;
}

void JournaledFile::read_seal() {
  Seal seal;
  if (stored_ < sizeof seal) return;
  read_all(descriptor_, path_, stored_ - sizeof seal, std::as_writable_bytes(std::span(&seal, 1)));
  if (seal.magic != Seal{}.magic || seal.reserved != 0 || seal.size != stored_ - sizeof seal) return;
  seal_ = seal.checksum;
  committed_ = stored_ = seal.size;
}

void JournaledFile::abandon() {
  if (abandoned_ || access_ == Access::read) return;
  abandoned_ = true;
  // Gives the space back; if it cannot, what lies beyond the committed end is ignored all the same.
  if (!journal_valid_ && !seal_)
    static_cast<void>(::ftruncate(descriptor_, static_cast<off_t>(committed_)) != 0);
}

bool JournaledFile::rename(const std::string& path, bool replace) {
  const auto refuse_other = [&](bool ours, const std::string& name) {
    if (!ours) throw IoError(name + ": another program has replaced or removed it meanwhile");
  };
  refuse_other(is_named(path_), path_);
  const std::string folder = folder_of(path);
  std::string name = path;  // once it is renamed nothing may fail for want of memory
  int failed = -1;
  if (!replace) failed = ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  if (!replace && failed != 0 && (errno == EINVAL || errno == ENOSYS)) {  // unknown to the file system
    failed = ::link(path_.c_str(), path.c_str());                         // which spares what is there, too
    if (failed == 0) ::unlink(path_.c_str());
  }
  if (replace) failed = std::rename(path_.c_str(), path.c_str());
  if (failed != 0) fail_with_errno(path, "cannot be given its name");
  bool ours = true;
  try {
    ours = is_named(path);
  } catch (const IoError&) {  // it was renamed, only looking fails
  }
  refuse_other(ours, path);
  path_.swap(name);
  return sync_folder(folder);
}

void JournaledFile::unlink() const {
  try {
    if (is_named(path_)) ::unlink(path_.c_str());
  } catch (const IoError&) {  // what stays was never committed, or is begun anew
  }
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
