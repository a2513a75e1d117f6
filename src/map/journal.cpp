// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/journal.hpp"

#include <libdeflate.h>

#include <array>
#include <cstring>

#include "leapmap/errors.hpp"
#include "support/file_calls.hpp"

namespace leapmap {
namespace {

/// Ends a journal on disk. Before it: each write as offset, length and bytes.
struct Footer {
  std::array<char, 16> magic{'l', 'e', 'a', 'p', 'm', 'a', 'p', ' ', 'j', 'o', 'u', 'r', 'n', 'a', 'l', '\n'};
  std::uint64_t begin = 0;  ///< of the journal in the file
  std::uint64_t size = 0;   ///< of the file once the writes are made
  std::uint32_t reserved = 0;
  std::uint32_t checksum = 0;  ///< CRC-32 of the journal up to here
};
static_assert(sizeof(Footer) == 40);

/// A seal on disk. Its checksum is of all bytes before that number.
struct SealBytes {
  std::array<char, 16> magic{'l', 'e', 'a', 'p', 'm', 'a', 'p', ' ', 'c', 'h', 'e', 'c', 'k', 's', 'u', 'm'};
  std::uint64_t size = 0;  ///< of the file before the seal
  std::uint32_t reserved = 0;
  std::uint32_t checksum = 0;  ///< CRC-32
};
static_assert(sizeof(SealBytes) == 32);

/// of_file: CRC-32 of the bytes before the seal.
std::uint32_t seal_checksum(std::uint32_t of_file, const SealBytes& seal) {
  return libdeflate_crc32(of_file, &seal, offsetof(SealBytes, checksum));
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

}  // namespace

void write_journal(int descriptor, const std::string& path, std::uint64_t begin, std::uint64_t size,
                   std::span<const WaitingWrite> writes) {
  const Footer footer{.begin = begin, .size = size};
  std::vector<std::byte> journal;
  for (const WaitingWrite& write : writes) {
    append(journal, write.offset);
    append(journal, std::uint64_t{write.bytes.size()});
    journal.insert(journal.end(), write.bytes.begin(), write.bytes.end());
  }
  append(journal, footer);
  const std::uint32_t checksum =
      libdeflate_crc32(0, journal.data(), journal.size() - sizeof(Footer::checksum));
  std::memcpy(journal.data() + journal.size() - sizeof checksum, &checksum, sizeof checksum);
  write_all(descriptor, path, begin, journal);
  sync(descriptor, path);
}

std::optional<Journal> read_journal(int descriptor, const std::string& path, std::uint64_t stored) {
  // Of changed metadata between two commits.
  constexpr std::uint64_t most = std::uint64_t{1} << 30;
  constexpr std::size_t most_writes = 1'000'000;
  Footer footer;
  if (stored < sizeof footer) return {};
  read_all(descriptor, path, stored - sizeof footer, std::as_writable_bytes(std::span(&footer, 1)));
  if (footer.magic != Footer{}.magic || footer.begin > stored - sizeof footer) return {};
  if (checksum_of(descriptor, path, footer.begin, stored - sizeof(Footer::checksum)) != footer.checksum)
    return {};
  const auto refuse_unless = [&](bool sense) {
    if (!sense) throw BrokenFile(path + ": is damaged: its journal is invalid");
  };
  refuse_unless(footer.size <= footer.begin && stored - footer.begin <= most);
  Journal journal{footer.begin, footer.size, {}};
  std::vector<std::byte> bytes(stored - sizeof footer - footer.begin);
  read_all(descriptor, path, footer.begin, bytes);
  for (std::span<const std::byte> left = bytes; !left.empty();) {
    std::array<std::uint64_t, 2> head{};  // offset, length
    refuse_unless(left.size() >= sizeof head);
    std::memcpy(head.data(), left.data(), sizeof head);
    left = left.subspan(sizeof head);
    refuse_unless(head[1] > 0 && journal.writes.size() < most_writes && head[1] <= left.size() &&
                  head[0] <= footer.begin && head[1] <= footer.begin - head[0]);
    journal.writes.push_back({head[0], {left.begin(), left.begin() + static_cast<std::ptrdiff_t>(head[1])}});
    left = left.subspan(head[1]);
  }
  return journal;
}

Seal write_seal(int descriptor, const std::string& path, std::uint64_t size, std::uint32_t checksum) {
  SealBytes seal{.size = size};
  seal.checksum = seal_checksum(checksum, seal);
  write_all(descriptor, path, size, std::as_bytes(std::span(&seal, 1)));
  sync(descriptor, path);
  return {size, seal.checksum};
}

std::optional<Seal> read_seal(int descriptor, const std::string& path, std::uint64_t stored) {
  SealBytes seal;
  if (stored < sizeof seal) return {};
  read_all(descriptor, path, stored - sizeof seal, std::as_writable_bytes(std::span(&seal, 1)));
  if (seal.magic != SealBytes{}.magic || seal.reserved != 0 || seal.size != stored - sizeof seal) return {};
  return Seal{seal.size, seal.checksum};
}

bool holds(const Seal& seal, int descriptor, const std::string& path) {
  return seal_checksum(checksum_of(descriptor, path, 0, seal.size), SealBytes{.size = seal.size}) ==
         seal.checksum;
}

}  // namespace leapmap
