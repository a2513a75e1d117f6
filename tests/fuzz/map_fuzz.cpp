// SPDX-License-Identifier: GPL-3.0-or-later
/// Any bytes as a map: what leapmap info, --resume and --retry-failed read of it is read, or refused with an
/// error.
///
/// The input is what is done to a map of ours through HDF5: each six bytes take one dataset or attribute
/// away, rename it, give it another type, shape or value, or have it lead to another file; then the file is
/// cut or not, or given a journal whose checksum is right and whose writes are the input's. It is not the
/// file's bytes: HDF5 1.10.8 itself crashes on some broken ones (four of 1,500 files with one to five random
/// bytes, all in H5HG_read, which reads texts), and what falls over there is no finding about our reader.
#include <hdf5_hl.h>
#include <libdeflate.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/map_layout.hpp"
#include "leapmap/errors.hpp"
#include "map/writer.hpp"
#include "spec/designs.hpp"
#include "spec/map_spec.hpp"
#include "support/small_map.hpp"
#include "support/temporary_folder.hpp"
#include "sweep/check.hpp"
#include "sweep/retry.hpp"

namespace {

using namespace leapmap;

const std::array names{
    "slope",          "mass_ratio", "design",        "jump_height",   "jump_time", "spurious_first_jump",
    "status",         "dip",        "filetype",      "version",       "spec",      "tiles_done",
    "tiles_checksum", "wall_time",  "entry",         "status_counts", "units",     "_FillValue",
    "title",          "CLASS",      "DIMENSION_LIST"};

std::string path(const std::string& name) {
  static const leapmap::testing::TemporaryFolder folder;
  return folder / name;
}

Spec fuzz_spec() {
  return parse_spec(
      "[design]\nslope = { values = [0.1, 0.2, 0.3] }\nmass_ratio = { values = [1, 2, 3, 4, 5] }\n", "fuzz",
      {});
}

/// A whole map or an unfinished one, made once.
const std::string& original(bool whole) {
  static std::array<std::string, 2> made;
  std::string& name = made[whole];
  if (!name.empty()) return name;
  name = path(whole ? "whole.h5" : "half.h5");
  const Spec spec = fuzz_spec();
  const MapLayout layout = layout_of(spec);
  const Tiling tiling({3, 5}, {2, 2});
  auto attributes = leapmap::testing::small_attributes;
  attributes.emplace_back("spec", resolved_text(spec));
  MapWriter writer = MapWriter::begin(name, layout, tiling, attributes, true);
  if (whole) {
    leapmap::testing::write_rest(writer, layout, tiling);
    if (!writer.finish({})) std::abort();
  } else {
    writer.write(leapmap::testing::numbered_tile(layout, tiling, 0));
    writer.keep();
    std::filesystem::rename(name + ".part", name);
  }
  return name;
}

/// Something that leads to another file.
void foreign(hid_t file, const char* name, hid_t type, hid_t space, std::uint8_t how) {
  const std::string elsewhere = original(true);
  H5Ldelete(file, name, H5P_DEFAULT);
  if (how % 3 == 0) {
    H5Lcreate_external(elsewhere.c_str(), name, file, name, H5P_DEFAULT, H5P_DEFAULT);
    return;
  }
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  how % 3 == 1 ? H5Pset_external(creation, elsewhere.c_str(), 0, H5F_UNLIMITED)
               : H5Pset_virtual(creation, space, elsewhere.c_str(), name, space);
  const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  if (how % 2) H5DSset_scale(dataset, name);
  H5Dclose(dataset);
  H5Pclose(creation);
}

/// Ends a file with a journal of one write, as the bytes say, whose checksum is right.
void add_journal(const std::string& path, std::span<const std::uint8_t> how) {
  const std::uint64_t size = std::filesystem::file_size(path);
  std::array<std::uint64_t, 4>
      numbers{};  // offset and length of the write, where the journal begins, the file's size
  for (std::size_t i = 0; i < numbers.size(); ++i)
    std::memcpy(&numbers[i], how.data() + 8 * i, 8), numbers[i] >>= how[32] % 64;
  if (how[32] & 64) numbers[2] = size;
  if (how[32] & 128) numbers[3] = size;
  std::vector<char> journal(16 + 40 + 8);
  std::memcpy(journal.data(), numbers.data(), 16);
  std::memcpy(journal.data() + 24, "leapmap journal\n", 16);
  std::memcpy(journal.data() + 40, numbers.data() + 2, 16);
  if (numbers[2] == size) {
    const std::uint32_t checksum = libdeflate_crc32(0, journal.data(), 60);
    std::memcpy(journal.data() + 60, &checksum, 4);
  }
  std::ofstream(path, std::ios::binary | std::ios::app).write(journal.data(), 64);
}

/// One change. Whatever HDF5 refuses is left.
void change(hid_t file, std::span<const std::uint8_t, 6> how) {
  const char* name = names[how[1] % names.size()];
  const char* on = how[2] % 3 ? "/" : names[how[2] / 3 % 8];
  const std::array<hid_t, 8> types{H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I32LE,   H5T_STD_U8LE,
                                   H5T_STD_I64BE,  H5T_C_S1,       H5T_STD_REF_OBJ, H5T_NATIVE_B8};
  const hid_t type = types[how[3] % types.size()];
  const std::array<hsize_t, 3> shape{how[4] % 7u, how[5] % 7u, 2};
  const int rank = how[4] / 7 % 4;
  const hid_t space = rank == 0 ? H5Screate(how[5] % 2 ? H5S_SCALAR : H5S_NULL)
                                : H5Screate_simple(rank, shape.data(), nullptr);
  std::array<std::uint8_t, 1024> bytes;
  bytes.fill(how[5]);
  switch (how[0] % 7) {
    case 6:
      foreign(file, name, type, space, how[4]);
      break;
    case 0:
      H5Ldelete(file, name, H5P_DEFAULT);
      break;
    case 1:
      H5Adelete_by_name(file, on, name, H5P_DEFAULT);
      break;
    case 2:
      H5Lmove(file, name, file, names[how[2] % names.size()], H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 3: {
      H5Ldelete(file, name, H5P_DEFAULT);
      const hid_t dataset = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      if (type != H5T_STD_REF_OBJ) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
      if (how[5] % 2) H5DSset_scale(dataset, name);
      H5Dclose(dataset);
      break;
    }
    case 4: {
      H5Adelete_by_name(file, on, name, H5P_DEFAULT);
      const hid_t attribute =
          H5Acreate_by_name(file, on, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      if (type != H5T_STD_REF_OBJ) H5Awrite(attribute, type, bytes.data());
      H5Aclose(attribute);
      break;
    }
    default: {
      const std::string text(1 + how[5] % 40, static_cast<char>('!' + how[4] % 90));
      try {
        hdf5::write_attribute(
            file, name,
            how[3] % 2 ? text : "[design]\nslope = { values = [" + std::to_string(how[4]) + "] }\n");
      } catch (const IoError&) {
      }
    }
  }
  H5Sclose(space);
}

void read_all(const std::string& name) {
  const MapReader map(name);
  std::size_t designs = 1;
  for (const std::size_t extent : map.shape()) designs *= extent;
  if (designs > 10000) return;
  const Tile all{std::vector<std::size_t>(map.shape().size(), 0), map.shape(), designs};
  for (const std::string& field : map.fields()) map.read(field, all), map.unit(field);
  for (const char* attribute : names) map.attribute(attribute);
  const Spec spec = spec_of(map, name);
  static_cast<void>(first_difference(spec, fuzz_spec()));
  if (shape_of(spec) == map.shape()) DesignSpace(spec).at(designs - 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 7) return 0;
  const std::string map = path("map.h5"), part = map + ".part";
  std::filesystem::copy_file(original(data[0] % 2), part, std::filesystem::copy_options::overwrite_existing);
  {
    hdf5::File file = hdf5::File::change(part);
    for (std::size_t i = 1; i + 6 <= size && i < 60; i += 6)
      change(file, std::span<const std::uint8_t, 6>(data + i, 6));
    file.close();
  }
  if (data[0] % 4 >= 2 && size > 8) {  // and a cut
    std::uint16_t cut = 0;
    std::memcpy(&cut, data + size - 2, 2);
    std::filesystem::resize_file(part, std::filesystem::file_size(part) * cut / 65536);
  }
  if (data[0] % 8 >= 4 && size > 40) add_journal(part, std::span(data + size - 33, 33));
  try {
    read_all(part);
  } catch (const IoError&) {
  } catch (const InputError&) {
  }
  try {
    const Spec spec = fuzz_spec();
    const MapLayout layout = layout_of(spec);
    const Tiling tiling({3, 5}, {2, 2});
    MapWriter writer = MapWriter::resume(map, layout, tiling, true);
    writer.verify();
  } catch (const IoError&) {
  } catch (const InputError&) {
  }
  try {
    if (spec_of(MapReader(part), part).list.count < 10000)
      static_cast<void>(check_map(part, {.sample = 3, .threads = 1}));
  } catch (const IoError&) {
  } catch (const InputError&) {
  }
  try {
    Spec spec = fuzz_spec();
    spec.numerics.method = "gsl-rk2";
    spec.numerics.tolerance = 1e-3;
    static_cast<void>(retry_with(part, spec, 1));
  } catch (const IoError&) {
  } catch (const InputError&) {
  }
  return 0;
}
