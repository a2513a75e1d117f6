// SPDX-License-Identifier: GPL-3.0-or-later
/// A file whose changes take effect all at once: whatever stops the program, kill -9 or a power cut, the file
/// is found as of its last commit.
///
/// What was committed is never overwritten in place: such writes wait in memory. A commit brings what was
/// appended to disk, then appends the waiting writes as a journal (a redo log with a checksum), then makes
/// them, then cuts the journal off. Whoever opens the file next finds a whole journal and makes its writes
/// again, or none, and all is as before. The first eight bytes, an HDF5 file's signature, of which none is
/// zero, always wait: a file in which one of them is zero was never committed. So the first commit needs no
/// journal, for nothing else waits, and what it writes last are these eight bytes.
///
/// The first call that fails is remembered: from then on every write and commit fails as well, so that what a
/// caller overlooked never reaches a commit. A file that is whole ends with a seal, a checksum of all of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "map/journal.hpp"

namespace leapmap {

/// What to do where the file system cannot lock a file.
enum class Locking {
  required,     ///< an error
  if_possible,  ///< go on without; a file that somebody else holds is refused all the same
};

class JournaledFile {
 public:
  enum class Access {
    read,    ///< of a file that exists; a journal is read as if it had been made
    change,  ///< of a file that exists; a journal is made
    create,  ///< anew; an existing file is emptied, once nobody else holds it
  };

  /// Opens and locks the file: several readers, or one writer. Throws InputError if somebody else holds it or
  /// it is a device, a pipe or a folder, BrokenFile if its journal makes no sense, IoError if it cannot be
  /// opened or locked.
  JournaledFile(const std::string& path, Access access, Locking locking = Locking::required);
  /// Abandons what was not committed.
  ~JournaledFile();
  JournaledFile(const JournaledFile&) = delete;
  JournaledFile& operator=(const JournaledFile&) = delete;

  /// Something beside its calls failed: nothing more is to be believed of it.
  void note_failure(const char* what) const;
  /// Throws the first failure again, if there was one: for a reader that took it for the file's.
  void rethrow_failure() const;
  /// Bytes from offset on, as last written; beyond the end: 0. Throws IoError.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;
  /// Throws IoError, for instance on a full disk; what was committed stays.
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  /// How long the file is from the next commit on.
  void resize(std::uint64_t size) { size_ = size; }
  std::uint64_t size() const { return size_; }
  /// All writes so far take effect, on disk when this returns, in a file size() bytes long. Throws IoError.
  void commit();
  /// Takes what was appended since the last commit to disk, so that the next one need not wait for it. Others
  /// may read the file meanwhile. Throws IoError, which is the caller's to note.
  void sync_appended();
  /// Forgets a failure: one of reading, which leaves what was written as it is.
  void forget_failure();
  /// Of the first `size` bytes, as last written. Others may read the file meanwhile. Throws IoError.
  std::uint32_t checksum(std::uint64_t size) const;
  /// Ends a file whose writes are all committed with its checksum. Throws IoError.
  void seal(std::uint32_t checksum);
  /// Whether the bytes are those that were sealed; unset: the file has no seal, or was changed since by
  /// another program that knows none. Reads the whole file. Throws IoError.
  std::optional<bool> seal_holds() const;
  /// Whether the file ends with a seal.
  bool is_sealed() const { return seal_.has_value(); }
  /// Drops what was not committed and gives its space back; from now on writes and commits do nothing. Waits
  /// for a sync that has begun.
  void abandon();
  /// Gives this very file another name, still locked, in place of an older file there if `replace`. Returns
  /// false if the folder could not be synced: the file is in its place, but a power cut may undo that. Throws
  /// IoError, also if another program has taken this file's name.
  [[nodiscard]] bool rename(const std::string& path, bool replace);
  /// Removes the file's name, if it is still this file's.
  void unlink() const;
  /// Whether `path` names this very file. Throws IoError.
  bool is_named(const std::string& path) const;

  /// Where the bytes written so far end.
  std::uint64_t end() const;
  /// True if nothing was ever committed.
  bool blank() const;
  const std::string& path() const { return path_; }
  Access access() const { return access_; }

 private:
  void open(Locking locking);
  void lock(Locking locking) const;
  /// As read, but does not remember a failure.
  void read_as_written(std::uint64_t offset, std::span<std::byte> bytes) const;
  void commit_first();
  void make_waiting_writes();
  /// Lets a thread bring to disk what was written so far, so that a commit has less to wait for; nothing
  /// while one is at it. Throws IoError if the one before failed.
  void begin_to_sync();
  /// Waits for that thread. Throws IoError if it failed, as the system reports lost bytes only once.
  void end_sync();
  /// Whether a write would change anything: HDF5 writes the same head again as it closes a file.
  bool differs(std::uint64_t offset, std::span<const std::byte> bytes) const;

  std::string path_;
  Access access_;
  int descriptor_ = -1;
  std::uint64_t committed_ = 0;        ///< bytes below it are not overwritten in place
  std::uint64_t stored_ = 0;           ///< bytes the file has on disk, a journal not counted
  std::uint64_t size_ = 0;             ///< bytes it is to have after the next commit
  std::uint64_t sync_begun_ = 0;       ///< bytes that are on their way to disk, or there
  std::future<void> syncing_;          ///< the thread that brings them there
  std::vector<WaitingWrite> waiting_;  ///< in the order they came
  std::optional<Seal> seal_;           ///< what ends the file on disk
  bool appended_ = false;              ///< since the last commit
  bool synced_ = false;                ///< since it was appended
  bool abandoned_ = false;
  bool journal_valid_ = false;  ///< the journal on disk is whole and must not be cut off
  mutable bool failed_ = false;
  mutable std::string failure_;  ///< the first one, in words

  /// Runs f unless a call failed before; remembers if it fails.
  template <class F>
  void attempt(const F& f) const;
};

}  // namespace leapmap
