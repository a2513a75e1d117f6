// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/journaled_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>

#include "leapmap/errors.hpp"
#include "support/system_calls.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

namespace fs = std::filesystem;
using Access = JournaledFile::Access;
using Bytes = std::vector<std::byte>;

/// What a file should hold: written to like one, all in memory.
void put(Bytes& model, std::uint64_t offset, const Bytes& bytes) {
  if (model.size() < offset + bytes.size()) model.resize(offset + bytes.size());
  std::ranges::copy(bytes, model.begin() + static_cast<std::ptrdiff_t>(offset));
}

Bytes content_of(const JournaledFile& file, std::size_t size) {
  Bytes bytes(size);
  file.read(0, bytes);
  return bytes;
}

Bytes bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Bytes bytes;
  for (std::istreambuf_iterator<char> i(file), end; i != end; ++i)
    bytes.push_back(static_cast<std::byte>(*i));
  return bytes;
}

void write_bytes(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// Some rounds of random writes, each with a commit: the states there should be after each, the first one
/// empty.
std::vector<Bytes> write_rounds(const std::string& path, unsigned seed) {
  std::mt19937 random(seed);
  const auto up_to = [&](std::size_t most) {
    return std::uniform_int_distribution<std::size_t>(0, most)(random);
  };
  JournaledFile file(path, Access::create);
  Bytes model;
  std::vector<Bytes> states{model};
  for (int round = 0; round < 6; ++round) {
    for (std::size_t n = 1 + up_to(4); n-- > 0;) {
      Bytes bytes(8 + up_to(60));
      for (std::byte& b : bytes) b = static_cast<std::byte>(1 + up_to(254));
      // over what is there, over its end, beyond it; the first bytes first, as in any HDF5 file
      const std::uint64_t offset = model.empty() ? 0 : up_to(model.size() + 20);
      file.write(offset, bytes);
      put(model, offset, bytes);
      EXPECT_EQ(content_of(file, model.size()), model) << "what was written is read back before a commit";
    }
    const Bytes stamp{static_cast<std::byte>(round + 1)};  // so that no two states are alike
    file.write(0, stamp);
    put(model, 0, stamp);
    if (round == 3) model.resize(model.size() - model.size() / 4);  // HDF5 gives space back now and then
    file.resize(model.size());
    if (round % 2 == 1) file.sync_appended();
    file.commit();
    states.push_back(model);
    EXPECT_EQ(content_of(file, model.size()), model);
  }
  return states;
}

/// The number of the state a file is found in; -1: none of them.
int state_of(const std::string& path, const std::vector<Bytes>& states, Access access) {
  const JournaledFile file(path, access);
  if (file.blank()) return 0;
  for (int i = static_cast<int>(states.size()); i-- > 1;) {
    const Bytes& state = states[static_cast<std::size_t>(i)];
    if (file.end() >= state.size() && content_of(file, state.size()) == state) return i;
  }
  return -1;
}

TEST(JournaledFile, HoldsWhatWasCommittedAndNothingElse) {
  const testing::TemporaryFolder folder;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto states = write_rounds(folder / "file", seed);
    EXPECT_EQ(bytes_of(folder / "file"), states.back()) << "no journal is left";
    {
      JournaledFile file(folder / "file", Access::change);
      file.write(0, Bytes(30, std::byte{1}));
      file.write(file.end() + 5, Bytes(30, std::byte{1}));
    }
    EXPECT_EQ(bytes_of(folder / "file"), states.back()) << "what was not committed is gone, and its space";
  }
}

TEST(JournaledFile, AfterAFailureNoCommitSucceedsNotEvenOneOfNothing) {
  const testing::TemporaryFolder folder;
  JournaledFile file(folder / "file", Access::create);
  file.write(0, Bytes(30, std::byte{1}));
  file.resize(30);
  file.commit();
  EXPECT_NO_THROW(file.commit());
  file.note_failure("a read failed");
  EXPECT_THROW(file.commit(), IoError);
}

TEST(JournaledFile, KilledAtAnyMomentIsFoundAsOfACommit) {
  const testing::TemporaryFolder folder;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto states = write_rounds(folder / "whole", seed);
    int before = 0, replayed = 0;
    for (long call = 0;; ++call) {
      fs::remove(folder / "file");
      const bool died = testing::dies_at_call(call, [&] { write_rounds(folder / "file", seed); });
      const int read = state_of(folder / "file", states, Access::read);
      const auto size = fs::file_size(folder / "file");
      const int changed = state_of(folder / "file", states, Access::change);
      replayed += fs::file_size(folder / "file") != size;
      ASSERT_GE(read, before) << "call " << call << ": a commit never goes back";
      ASSERT_LE(read, before + 1);
      ASSERT_EQ(changed, read) << "a reader sees a journal as a writer would make it";
      before = read;
      if (!died) break;
    }
    EXPECT_EQ(before, 6);
    EXPECT_GE(replayed, 6) << "at each commit some moments leave a whole journal";
  }
}

TEST(JournaledFile, APowerCutThatLosesWhatWasNotSyncedLeavesACommit) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(1);
  struct Call {
    testing::SystemCall::Kind kind;
    std::uint64_t offset;
    Bytes bytes;
  };
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::vector<Call> calls;
    testing::before_system_call = [&](const testing::SystemCall& call) {
      calls.push_back({call.kind, call.offset, {call.bytes.begin(), call.bytes.end()}});
    };
    const auto states = write_rounds(folder / "whole", seed);
    testing::before_system_call = nullptr;
    int before = 0;
    for (std::size_t cut = 0; cut <= calls.size(); ++cut) {
      // Up to the last sync all is on disk; of what came after, any part, and the file's size as of any
      // moment.
      std::size_t synced = 0;
      for (std::size_t i = 0; i < cut; ++i)
        if (calls[i].kind == testing::SystemCall::Kind::sync) synced = i + 1;
      int least = 6;
      for (int trial = 0; trial < 8; ++trial) {
        Bytes disk;
        for (std::size_t i = 0; i < cut; ++i) {
          if (i >= synced && random() % 2) continue;
          if (calls[i].kind == testing::SystemCall::Kind::write) put(disk, calls[i].offset, calls[i].bytes);
          if (calls[i].kind == testing::SystemCall::Kind::truncate) disk.resize(calls[i].offset);
        }
        write_bytes(folder / "file", disk);
        const int state = state_of(folder / "file", states, Access::change);
        ASSERT_GE(state, before) << "cut before call " << cut << ": what a commit brought to disk stays";
        least = std::min(least, state);
      }
      before = least;
    }
    EXPECT_EQ(before, 6);
  }
}

TEST(JournaledFile, ACutOrForeignEndIsNoJournal) {
  const testing::TemporaryFolder folder;
  write_rounds(folder / "file", 1);
  const Bytes whole = bytes_of(folder / "file");
  Bytes like_one = whole;  // ends as a journal does, but its checksum is wrong
  for (const char c : std::string("leapmap journal\n")) like_one.push_back(static_cast<std::byte>(c));
  like_one.resize(like_one.size() + 24);
  write_bytes(folder / "like", like_one);
  EXPECT_EQ(content_of(JournaledFile(folder / "like", Access::change), like_one.size()), like_one);
  EXPECT_EQ(fs::file_size(folder / "like"), like_one.size());
}

TEST(JournaledFile, IsHeldByOneWriterOrSeveralReaders) {
  const testing::TemporaryFolder folder;
  write_rounds(folder / "file", 1);
  const auto open = [&](Access access) { JournaledFile(folder / "file", access); };
  {
    const JournaledFile writer(folder / "file", Access::change);
    for (const Access access : {Access::read, Access::change, Access::create})
      EXPECT_THROW(open(access), InputError);
  }
  const Bytes before = bytes_of(folder / "file");
  {
    const JournaledFile reader(folder / "file", Access::read);
    EXPECT_NO_THROW(open(Access::read));
    EXPECT_THROW(open(Access::create), InputError);
  }
  EXPECT_EQ(bytes_of(folder / "file"), before) << "a file that is held is not emptied";
  EXPECT_THROW(JournaledFile(folder / "nowhere", Access::read), IoError);
}

TEST(JournaledFile, KeepsItsLastCommitWhenTheDiskIsFull) {
  const testing::TemporaryFolder folder;
  Bytes committed;
  {
    JournaledFile file(folder / "file", Access::create);
    put(committed, 0, Bytes(100, std::byte{7}));
    file.write(0, committed);
    file.resize(100);
    file.commit();
    file.write(50, Bytes(10, std::byte{8}));
    file.write(100, Bytes(10, std::byte{8}));
    testing::before_system_call = [](const testing::SystemCall& call) {
      if (call.kind == testing::SystemCall::Kind::write) throw IoError("no space left");
    };
    file.resize(110);
    EXPECT_THROW(file.commit(), IoError);
    testing::before_system_call = nullptr;
  }
  EXPECT_EQ(bytes_of(folder / "file"), committed);
}

TEST(JournaledFile, RemembersItsFirstFailureAndCommitsNothingAfterIt) {
  const testing::TemporaryFolder folder;
  const auto states = write_rounds(folder / "file", 1);
  {
    JournaledFile file(folder / "file", Access::change);
    long call = 0;
    testing::before_system_call = [&](const testing::SystemCall& c) {
      if (c.kind == testing::SystemCall::Kind::write && call++ == 1) throw IoError("the second write fails");
    };
    file.write(file.end(), Bytes(10, std::byte{8}));
    EXPECT_THROW(file.write(file.end(), Bytes(10, std::byte{8})), IoError);
    testing::before_system_call = nullptr;  // from here on the disk works again
    EXPECT_THROW(file.write(file.end(), Bytes(10, std::byte{8})), IoError);
    EXPECT_THROW(file.commit(), IoError);
    EXPECT_THROW(file.seal(file.checksum(file.size())), IoError);
    EXPECT_THROW(file.rethrow_failure(), IoError);
  }
  EXPECT_EQ(bytes_of(folder / "file"), states.back());
}

TEST(JournaledFile, ASyncThatFailsWhileTheFileGrowsIsItsFailure) {
  const testing::TemporaryFolder folder;
  const Bytes committed(8, std::byte{7});
  int syncs = 0;
  std::thread::id by;
  {
    JournaledFile file(folder / "file", Access::create);
    file.write(0, committed);
    file.resize(committed.size());
    file.commit();
    // Only the first sync fails: the system reports lost bytes once.
    testing::before_system_call = [&](const testing::SystemCall& call) {
      if (call.kind != testing::SystemCall::Kind::sync || syncs++ > 0) return;
      by = std::this_thread::get_id();
      throw IoError("bytes were lost");
    };
    const Bytes much(std::size_t{5} << 20, std::byte{8});
    file.write(committed.size(), much);
    file.resize(committed.size() + much.size());
    EXPECT_THROW(file.commit(), IoError);
    EXPECT_EQ(syncs, 1) << "a commit does not go on after that";
    EXPECT_NE(by, std::this_thread::get_id()) << "another thread syncs while the file grows";
    EXPECT_THROW(file.commit(), IoError);
    testing::before_system_call = nullptr;
  }
  EXPECT_EQ(bytes_of(folder / "file"), committed);
}

TEST(JournaledFile, IsSealedWithAChecksumThatEveryChangedBitBreaks) {
  const testing::TemporaryFolder folder;
  const auto states = write_rounds(folder / "file", 2);
  {
    JournaledFile file(folder / "file", Access::change);
    EXPECT_FALSE(file.seal_holds().has_value()) << "not yet";
    file.commit();
    file.seal(file.checksum(file.size()));
  }
  const Bytes sealed = bytes_of(folder / "file");
  ASSERT_EQ(sealed.size(), states.back().size() + 32);
  EXPECT_EQ(JournaledFile(folder / "file", Access::read).seal_holds(), true);
  EXPECT_EQ(JournaledFile(folder / "file", Access::read).end(), states.back().size()) << "it is no content";
  for (std::size_t i = 0; i < sealed.size(); i += 7) {
    Bytes changed = sealed;
    changed[i] ^= std::byte{4};
    write_bytes(folder / "changed", changed);
    EXPECT_NE(JournaledFile(folder / "changed", Access::read).seal_holds(), true) << "byte " << i;
  }
  {
    JournaledFile file(folder / "file", Access::change);
    file.write(file.end(), Bytes(3, std::byte{9}));
    file.resize(file.end());
    file.commit();
  }
  EXPECT_EQ(bytes_of(folder / "file").size(), states.back().size() + 3) << "a change takes the seal away";
}

TEST(JournaledFile, IsSealedAgainAfterItGrewByBytesThatNobodyWrote) {
  const testing::TemporaryFolder folder;
  const auto states = write_rounds(folder / "file", 2);
  {
    JournaledFile file(folder / "file", Access::change);
    file.seal(file.checksum(file.size()));
  }
  {
    JournaledFile file(folder / "file", Access::change);
    const std::uint64_t end = file.end();
    file.write(end + 9, Bytes(1, std::byte{9}));  // the seal's bytes were there
    file.resize(end + 10);
    const std::uint32_t checksum = file.checksum(file.size());
    file.commit();
    file.seal(checksum);
  }
  EXPECT_EQ(JournaledFile(folder / "file", Access::read).seal_holds(), true);
}

TEST(JournaledFile, RenamesItselfAndNobodyElse) {
  const testing::TemporaryFolder folder;
  write_rounds(folder / "file", 1);
  JournaledFile file(folder / "file", Access::change);
  fs::remove(folder / "file");
  folder.write("file", "another's");
  EXPECT_THROW(static_cast<void>(file.rename(folder / "named", true)), IoError);
  file.unlink();
  EXPECT_TRUE(fs::exists(folder / "file")) << "it is another's";
  EXPECT_FALSE(fs::exists(folder / "named"));
}

TEST(JournaledFile, WritesNoFileThatHasAnotherNameToo) {
  const testing::TemporaryFolder folder;
  write_rounds(folder / "file", 1);
  fs::create_hard_link(folder / "file", folder / "file.part");
  const auto before = bytes_of(folder / "file");
  for (const Access access : {Access::change, Access::create})
    EXPECT_THROW(JournaledFile(folder / "file.part", access), InputError);
  EXPECT_EQ(bytes_of(folder / "file"), before);
  EXPECT_NO_THROW(JournaledFile(folder / "file", Access::read));
  fs::remove(folder / "file.part");
  EXPECT_NO_THROW(JournaledFile(folder / "file", Access::change));
}

TEST(JournaledFile, IsAFileAndNothingElse) {
  const testing::TemporaryFolder folder;
  for (const Access access : {Access::read, Access::change, Access::create})
    EXPECT_THROW(JournaledFile("/dev/null", access), InputError);
  EXPECT_THROW(JournaledFile(folder / ".", Access::read), InputError);
}

}  // namespace
}  // namespace leapmap
