// SPDX-License-Identifier: GPL-3.0-or-later
/// A thin layer over the HDF5 C API: handles that close themselves, errors that are exceptions, attributes by
/// value.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "map/hdf5_virtual.hpp"

namespace leapmap::hdf5 {

/// Throws IoError with `what` and HDF5's innermost reason. HDF5's own printing is off.
[[noreturn]] void fail(const std::string& what);

/// Initialises HDF5 for this process, without its handler at exit, which can hang after a full disk, and
/// makes it quiet for this thread. To be called on each thread that calls HDF5.
void initialise();

/// Owns an identifier of any kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// Throws IoError with `what` if id is not valid.
  Handle(hid_t id, Close closer, const std::string& what) : id_(id), close_(closer) {
    if (id < 0) fail(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  /// Closes without a word: what was written to is closed by close, which tells.
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  /// Closes now. Throws IoError with `what` if HDF5 cannot, for instance because the disk is full.
  void close(const std::string& what) {
    if (id_ >= 0 && close_(std::exchange(id_, H5I_INVALID_HID)) < 0) fail(what);
  }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Throws IoError with `what` unless an HDF5 call succeeded.
inline void check(herr_t status, const std::string& what) {
  if (status < 0) fail(what);
}

/// A dataset to be created: creation order tracked, chunked if chunk is not empty, virtual if it has sources.
struct DatasetPlan {
  std::string name;
  hid_t type;
  std::span<const hsize_t> shape;
  std::span<const hsize_t> chunk = {};
  const void* fill = nullptr;            ///< of `type`; unset: zero
  int compression = 0;                   ///< > 0: bytes shuffled (but single ones), deflated at that level
  bool checksums = false;                ///< of a chunked one: each chunk ends with HDF5's fletcher32
  std::span<const Source> sources = {};  ///< of a virtual one, which has no values of its own
};
Handle create_dataset(hid_t file, const DatasetPlan& plan);

/// The values of a one-dimensional dataset: numbers, texts (UTF-8 of variable length), or codes with a
/// meaning each, separated by blanks.
struct Codes {
  std::vector<std::uint8_t> values, allowed;
  std::string meanings;
};
using SeriesValues = std::variant<std::vector<double>, std::vector<std::string>, Codes>;
std::size_t size_of(const SeriesValues& values);

/// Writes a one-dimensional dataset with units and long_name. `scale` is its dimension; unset: it is a
/// dimension scale itself. Returns the dataset, which is to be closed by close.
Handle write_series(hid_t file, const std::string& name, std::string_view unit, std::string_view long_name,
                    const SeriesValues& values, const Handle* scale);
/// Whether a dataset holds these values, bit for bit. Throws IoError if it cannot be read.
bool holds(hid_t file, const std::string& name, const SeriesValues& values);
/// The texts of a one-dimensional dataset. Throws IoError, also for a text of more than most_bytes.
std::vector<std::string> read_texts(hid_t dataset, std::size_t most_bytes, const std::string& what);

/// Attributes: UTF-8 text of variable length, or numbers of the given file type. An older one of that name
/// goes.
void write_attribute(hid_t object, const std::string& name, std::string_view text);
void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::span<const double> values);
void write_attribute(hid_t object, const std::string& name, std::span<const float> values);
void write_attribute(hid_t object, const std::string& name, std::int64_t value);
void write_attribute(hid_t object, const std::string& name, std::span<const std::int64_t> values);
void write_attribute(hid_t object, const std::string& name, std::span<const std::int32_t> values);
void write_attribute(hid_t object, const std::string& name, std::span<const std::uint8_t> values);

/// A named value of a file's root.
using Attribute = std::pair<std::string, std::variant<std::string, double, std::int64_t,
                                                      std::vector<std::int64_t>, std::vector<std::int32_t>>>;
void annotate(hid_t object, std::span<const Attribute> attributes);

/// No error if there is none.
void remove_attribute(hid_t object, const std::string& name);

bool has_attribute(hid_t object, const std::string& name);
/// Each throws IoError if there is no such attribute, or it is of another kind.
std::string read_text(hid_t object, const std::string& name);
/// A number that is none, or infinite where it may not be, is of another kind.
double read_number(hid_t object, const std::string& name, bool may_be_infinite = false);
/// most: numbers that there may be.
std::vector<std::int64_t> read_integers(hid_t object, const std::string& name, std::size_t most = 64);

/// One of them, in a range; BrokenFile if it is outside.
std::int64_t read_integer(hid_t object, const std::string& name, std::int64_t least,
                          std::int64_t most = std::numeric_limits<std::int64_t>::max());

/// The raw bytes of a chunk as stored, and which filters were skipped for it. Throws IoError.
std::uint32_t read_chunk(hid_t dataset, const std::vector<hsize_t>& place, std::vector<std::byte>& bytes,
                         const std::string& what);

/// A block of a dataset in C order, as doubles whatever its type. `what` is for messages. Throws IoError.
std::vector<double> read_block(hid_t dataset, const std::vector<std::size_t>& start,
                               const std::vector<std::size_t>& extent, const std::string& what);
void write_block(hid_t dataset, const std::vector<std::size_t>& start, const std::vector<std::size_t>& extent,
                 std::span<const double> values, const std::string& what);

/// The same for words of 64 bits.
std::vector<std::uint64_t> read_words(hid_t dataset, const std::vector<std::size_t>& start,
                                      const std::vector<std::size_t>& extent, const std::string& what);
void write_words(hid_t dataset, const std::vector<std::size_t>& start, const std::vector<std::size_t>& extent,
                 std::span<const std::uint64_t> values, const std::string& what);

/// How long the file of an object is. Throws IoError.
std::uint64_t file_bytes(hid_t object);

/// The shape of a dataset's chunks; empty: it has none.
std::vector<hsize_t> chunk_of(hid_t dataset);

/// A dataset's number of values along each dimension.
std::vector<hsize_t> shape_of(hid_t dataset);

}  // namespace leapmap::hdf5
