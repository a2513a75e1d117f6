// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/journaled_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "leapmap/errors.hpp"
#include "support/file_calls.hpp"
#include "support/output_file.hpp"
#include "support/posix.hpp"

namespace leapmap {
namespace {

constexpr std::uint64_t signature_bytes = 8;

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

void JournaledFile::note_failure(const char* what) const {
  if (!failed_) failure_ = what;
  failed_ = true;
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
  if (access_ != Access::read && status_of(descriptor_, path_).st_nlink > 1)
    throw InputError(path_ +
                     ": has several names (hard links), all of which would be changed; allowed: a "
                     "file with one name");
  if (access_ == Access::create) return cut(descriptor_, path_, 0);
  committed_ = stored_ = static_cast<std::uint64_t>(status_of(descriptor_, path_).st_size);
  seal_ = read_seal(descriptor_, path_, stored_);
  if (seal_) {
    committed_ = stored_ = seal_->size;
  } else if (auto journal = read_journal(descriptor_, path_, stored_)) {
    waiting_ = std::move(journal->writes);
    journal_valid_ = true;
    committed_ = journal->size;
    stored_ = journal->begin;
  }
  size_ = committed_;
  sync_begun_ = stored_;
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
    fail_with_errno(path, "cannot be examined");
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
    throw InputError(fmt::format("{}: a sweep or another program is {} it; allowed: after it has ended",
                                 path_, reads ? "writing" : "using"));
}

void JournaledFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  attempt([&] { read_as_written(offset, bytes); });
}

void JournaledFile::read_as_written(std::uint64_t offset, std::span<std::byte> bytes) const {
  const std::uint64_t end = offset + bytes.size();
  const std::size_t there = offset < stored_ ? std::min<std::uint64_t>(bytes.size(), stored_ - offset) : 0;
  read_all(descriptor_, path_, offset, bytes.first(there));
  std::ranges::fill(bytes.subspan(there), std::byte{0});
  for (const WaitingWrite& write : waiting_) {
    const std::uint64_t first = std::max(offset, write.offset),
                        last = std::min(end, write.offset + write.bytes.size());
    if (first < last)
      std::memcpy(bytes.data() + (first - offset), write.bytes.data() + (first - write.offset), last - first);
  }
}

bool JournaledFile::differs(std::uint64_t offset, std::span<const std::byte> bytes) const {
  std::vector<std::byte> there(bytes.size());
  read(offset, there);
  return !std::ranges::equal(there, bytes);
}

void JournaledFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (abandoned_) return;
  attempt([&] {
    const std::uint64_t guarded = std::max(committed_, signature_bytes);
    if (offset < guarded) {
      const auto waits = bytes.first(std::min<std::uint64_t>(bytes.size(), guarded - offset));
      if (!waiting_.empty() || differs(offset, waits))
        waiting_.push_back({offset, {waits.begin(), waits.end()}});
      bytes = bytes.subspan(waits.size());
      offset += waits.size();
    }
    if (bytes.empty()) return;
    if (seal_) cut(descriptor_, path_, stored_);  // its bytes are no content where the file grows
    seal_.reset();
    appended_ = true, synced_ = false;
    write_all(descriptor_, path_, offset, bytes);
    stored_ = std::max(stored_, offset + bytes.size());
    constexpr std::uint64_t much = std::uint64_t{4} << 20;
    if (stored_ >= sync_begun_ + much) begin_to_sync();
  });
}

void JournaledFile::begin_to_sync() {
  if (syncing_.valid()) {
    // The disk is slow: a later call syncs this as well.
    if (syncing_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return;
    end_sync();
  }
  sync_begun_ = stored_;
  syncing_ = std::async(std::launch::async | std::launch::deferred,
                        [descriptor = descriptor_, path = path_] { sync(descriptor, path); });
}

void JournaledFile::end_sync() {
  if (syncing_.valid()) syncing_.get();
}

void JournaledFile::commit() {
  if (abandoned_) return;
  attempt([&] {
    end_sync();
    if (!appended_ && waiting_.empty() && size_ == committed_) return;  // nothing has changed
    if (committed_ == 0) return commit_first();
    // What was appended has to be there before anything refers to it.
    if (std::exchange(appended_, false) && !synced_) sync(descriptor_, path_);
    if (!waiting_.empty()) {
      write_journal(descriptor_, path_, std::max(size_, stored_), size_, waiting_);
      journal_valid_ = true;
    }
    committed_ = size_;
    make_waiting_writes();
  });
}

void JournaledFile::sync_appended() {
  if (abandoned_ || !appended_) return;
  end_sync();
  sync(descriptor_, path_);
  synced_ = true;
}

void JournaledFile::forget_failure() {
  failed_ = false;
  failure_.clear();
}

void JournaledFile::commit_first() {
  std::vector<std::byte> first(std::min(size_, signature_bytes));
  read(0, first);
  cut(descriptor_, path_, size_);
  sync(descriptor_, path_);
  write_all(descriptor_, path_, 0, first);
  appended_ = false;
  waiting_.clear();
  committed_ = stored_ = sync_begun_ = size_;
  sync(descriptor_, path_);
  if (!sync_folder(folder_of(path_))) throw IoError(path_ + ": its folder cannot be synced to disk");
}

std::uint32_t JournaledFile::checksum(std::uint64_t size) const {
  return checksum_of(
      0, size, [&](std::uint64_t offset, std::span<std::byte> bytes) { read_as_written(offset, bytes); });
}

void JournaledFile::seal(std::uint32_t checksum) {
  if (abandoned_) return;
  attempt([&] { seal_ = write_seal(descriptor_, path_, committed_, checksum); });
}

std::optional<bool> JournaledFile::seal_holds() const {
  if (!seal_) return std::nullopt;
  return holds(*seal_, descriptor_, path_);
}

void JournaledFile::make_waiting_writes() {
  for (const WaitingWrite& write : waiting_) write_all(descriptor_, path_, write.offset, write.bytes);
  if (!waiting_.empty()) sync(descriptor_, path_);
  cut(descriptor_, path_, committed_);
  seal_.reset();
  journal_valid_ = false;
  waiting_.clear();
  stored_ = sync_begun_ = committed_;
}

void JournaledFile::abandon() {
  if (abandoned_ || access_ == Access::read) return;
  abandoned_ = true;
  if (syncing_.valid()) syncing_.wait();
  // Gives the space back; if it cannot, what lies beyond the committed end is ignored all the same.
  if (!journal_valid_ && !seal_)
    static_cast<void>(::ftruncate(descriptor_, static_cast<off_t>(committed_)) != 0);
}

bool JournaledFile::rename(const std::string& path, bool replace) {
  const auto refuse_other = [&](bool ours, const std::string& name) {
    if (!ours) throw IoError(name + ": another program has replaced or removed it");
  };
  refuse_other(is_named(path_), path_);
  const std::string folder = folder_of(path);
  if (struct stat replaced{}; replace && ::stat(path.c_str(), &replaced) == 0 && S_ISREG(replaced.st_mode))
    take_over(descriptor_, replaced);
  std::string name = path;  // once it is renamed nothing may fail for want of memory
  int failed = -1;
  if (!replace) failed = ::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  if (!replace && failed != 0 && (errno == EINVAL || errno == ENOSYS)) {  // unknown to the file system
    failed = ::link(path_.c_str(), path.c_str());                         // which spares what is there, too
    if (failed == 0 && ::unlink(path_.c_str()) != 0) fail_with_errno(path_, "cannot be removed");
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
  for (const WaitingWrite& write : waiting_)
    end = std::max<std::uint64_t>(end, write.offset + write.bytes.size());
  return end;
}

bool JournaledFile::blank() const {
  std::array<std::byte, signature_bytes> first{};
  read(0, first);
  const auto is_zero = [](std::byte b) { return b == std::byte{0}; };
  return end() < signature_bytes ? std::ranges::all_of(first, is_zero) : std::ranges::any_of(first, is_zero);
}

}  // namespace leapmap
