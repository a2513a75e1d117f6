// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5_driver.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <new>

#include "support/errors.hpp"

namespace leapmap::hdf5 {
namespace {

/// What HDF5 holds of an open file.
struct Driver : H5FD_t {
  JournaledFile* file = nullptr;
};

/// What the property list of an open carries to it.
struct Target {
  JournaledFile* file;
};

Driver& driver(H5FD_t* base) { return *static_cast<Driver*>(base); }
const Driver& driver(const H5FD_t* base) { return *static_cast<const Driver*>(base); }

/// Runs f; its exception becomes HDF5's error, as none may pass through C.
template <class F>
herr_t guarded(const F& f) {
  try {
    f();
    return 0;
  } catch (const std::exception& error) {
    H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_IO, H5E_WRITEERROR, "%s",
             error.what());
    return -1;
  }
}

H5FD_t* open(const char*, unsigned, hid_t access, haddr_t) {
  const auto* target = static_cast<const Target*>(H5Pget_driver_info(access));
  auto* opened = new (std::nothrow) Driver;
  if (opened) opened->file = target->file;
  return opened;
}

herr_t flush(H5FD_t* base, hid_t, hbool_t) {
  return guarded([&] { driver(base).file->commit(); });
}

/// Commits nothing: HDF5 closes a file it could not make sense of as well. File::close commits.
herr_t close(H5FD_t* base) {
  delete &driver(base);
  return 0;
}

/// The features of HDF5's own driver for POSIX files, but for the handle.
herr_t query(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

/// HDF5 allocates space by moving the file's end.
haddr_t get_eoa(const H5FD_t* base, H5FD_mem_t) { return driver(base).file->size(); }

herr_t set_eoa(H5FD_t* base, H5FD_mem_t, haddr_t end) {
  driver(base).file->resize(end);
  return 0;
}

haddr_t get_eof(const H5FD_t* base, H5FD_mem_t) { return driver(base).file->end(); }

herr_t read(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t offset, size_t size, void* buffer) {
  return guarded([&] { driver(base).file->read(offset, {static_cast<std::byte*>(buffer), size}); });
}

herr_t write(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t offset, size_t size, const void* buffer) {
  return guarded([&] { driver(base).file->write(offset, {static_cast<const std::byte*>(buffer), size}); });
}

hid_t driver_id() {
  static const H5FD_class_t driver_class = [] {
    H5FD_class_t made{};
    made.name = "leapmap_journaled";
    made.maxaddr = (haddr_t{1} << 63) - 1;
    made.fc_degree = H5F_CLOSE_WEAK;
    made.fapl_size = sizeof(Target);
    made.open = open;
    made.close = close;
    made.query = query;
    made.get_eoa = get_eoa;
    made.set_eoa = set_eoa;
    made.get_eof = get_eof;
    made.read = read;
    made.write = write;
    made.flush = flush;
    const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;  // raw data and metadata aggregate apart, as HDF5's own do
    std::copy(std::begin(map), std::end(map), made.fl_map);
    return made;
  }();
  static const hid_t id = H5FDregister(&driver_class);
  return id;
}

Handle access_to(JournaledFile& file) {
  initialise();
  const Target target{&file};
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file.path());
  check(H5Pset_driver(access, driver_id(), &target), file.path());
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG),
        file.path());                                // nothing may write after we have closed
  if (file.access() != JournaledFile::Access::read)  // a map that others have repacked may be read as well
    check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18), file.path());
  return access;
}

Handle creation_of(const std::string& path) {
  Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, path);
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path);
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path);
  return creation;
}

Handle open_in(JournaledFile& file, unsigned flags) {
  const Handle access = access_to(file);
  try {
    return {H5Fopen(file.path().c_str(), flags, access), H5Fclose, file.path() + ": cannot be read as HDF5"};
  } catch (const IoError& error) {
    throw BrokenFile(error.what());
  }
}

}  // namespace

File File::create(const std::string& path) {
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw IoError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  File file(std::make_unique<JournaledFile>(path, JournaledFile::Access::create));
  const Handle access = access_to(*file.bytes_), creation = creation_of(path);
  file.handle_ = {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose,
                  path + ": cannot be created"};
  return file;
}

File File::open(const std::string& path) {
  File file(std::make_unique<JournaledFile>(path, JournaledFile::Access::read));
  file.handle_ = open_in(*file.bytes_, H5F_ACC_RDONLY);
  return file;
}

File File::change(const std::string& path) {
  File file(std::make_unique<JournaledFile>(path, JournaledFile::Access::change));
  file.handle_ = open_in(*file.bytes_, H5F_ACC_RDWR);
  file.flush();  // cuts off what was written after the last one
  return file;
}

File File::copy(const std::string& from, const std::string& to) {
  const JournaledFile original(from, JournaledFile::Access::read);
  File file(std::make_unique<JournaledFile>(to, JournaledFile::Access::create));
  std::vector<std::byte> bytes(std::size_t{1} << 20);
  for (std::uint64_t offset = 0; offset < original.end(); offset += bytes.size()) {
    bytes.resize(std::min<std::uint64_t>(bytes.size(), original.end() - offset));
    original.read(offset, bytes);
    file.bytes_->write(offset, bytes);
  }
  file.bytes_->resize(original.end());
  std::error_code ignored;
  std::filesystem::permissions(to, std::filesystem::status(from, ignored).permissions(), ignored);
  file.handle_ = open_in(*file.bytes_, H5F_ACC_RDWR);
  return file;
}

bool File::blank(const std::string& path) { return JournaledFile(path, JournaledFile::Access::read).blank(); }

File& File::operator=(File&& other) noexcept {
  abandon();
  bytes_ = std::move(other.bytes_);
  handle_ = std::move(other.handle_);
  return *this;
}

File::~File() { abandon(); }

void File::flush() { check(H5Fflush(handle_, H5F_SCOPE_LOCAL), bytes_->path() + ": cannot be written"); }

void File::close() {
  flush();
  if (!handle_.close()) fail(bytes_->path() + ": cannot be written");
  bytes_->commit();  // HDF5 writes its last as it closes
}

void refuse_other_file(const std::string& path, std::string_view filetype) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored) || !std::filesystem::is_regular_file(path, ignored)) return;
  bool same = false;
  try {
    const File file = File::open(path);
    same = has_attribute(file, "filetype") && read_text(file, "filetype") == filetype;
  } catch (const IoError&) {
  }
  if (!same)
    throw InputError(fmt::format("{}: exists and is no {}; allowed: a new name, or an older one to replace",
                                 path, filetype));
}

void File::finish(const std::string& path, bool replace) {
  close();
  bytes_->rename(path, replace);
  bytes_.reset();
}

void File::discard() {
  ::unlink(bytes_->path().c_str());  // while it is still ours
  abandon();
}

void File::abandon() {
  if (!bytes_) return;
  bytes_->abandon();
  static_cast<void>(handle_.close());  // nothing reaches the file any more, so that nothing can go wrong
  bytes_.reset();
}

}  // namespace leapmap::hdf5
