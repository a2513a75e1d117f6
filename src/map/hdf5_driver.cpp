// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/hdf5_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <future>
#include <iterator>
#include <memory>

#include "leapmap/errors.hpp"
#include "map/hdf5_trust.hpp"
#include "support/output_file.hpp"
#include "support/posix.hpp"

namespace leapmap::hdf5 {
namespace {

/// What HDF5 holds of an open file. It shares the file: where HDF5 cannot close, its driver outlives us.
struct Driver : H5FD_t {
  std::shared_ptr<JournaledFile> file;
  std::shared_ptr<const SourceNames> sources;  ///< known when it has been looked through
};

/// What the property list of an open carries to it.
struct Target {
  const std::shared_ptr<JournaledFile>* file;
  const std::shared_ptr<const SourceNames>* sources;
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

/// A source of the target, whatever folder HDF5 looks for it in: it lies beside the target. Where it cannot
/// be opened HDF5 would go on with fill values: the target is told, which has failed then.
std::shared_ptr<JournaledFile> source_of(const Target& target, const std::string& name) {
  try {
    return std::make_shared<JournaledFile>(path_beside((*target.file)->path(), name),
                                           JournaledFile::Access::read, Locking::if_possible);
  } catch (const std::exception& error) {
    (*target.file)->note_failure(error.what());
    throw;
  }
}

/// Opens the target or one of its sources, and no other file: HDF5 comes here too for a file that another one
/// refers to.
H5FD_t* open(const char* name, unsigned, hid_t access, haddr_t) {
  const auto* target = static_cast<const Target*>(H5Pget_driver_info(access));
  std::unique_ptr<Driver> opened;
  const herr_t done = guarded([&] {
    if (target && (*target->file)->path() == name) {
      opened.reset(new Driver{{}, *target->file, *target->sources});
      return;
    }
    const std::string plain = std::filesystem::path(name).filename().string();
    if (!target || !*target->sources || !(*target->sources)->contains(plain))
      throw IoError("it refers to another file");
    opened.reset(new Driver{{}, source_of(*target, plain), nullptr});
  });
  if (done < 0 && target && (*target->file)->path() == name) (*target->file)->note_failure("out of memory");
  return opened.release();
}

/// How HDF5 opens the sources of a file: as the file itself.
void* access_of(H5FD_t* base) {
  auto* target = static_cast<Target*>(H5allocate_memory(sizeof(Target), false));
  if (target) *target = {&driver(base).file, &driver(base).sources};
  return target;
}

/// Commits nothing: HDF5 closes a file it could not make sense of as well. File commits.
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
  // What fails is noted by the file, and every commit throws it from then on. HDF5 is not told: of a file
  // that it could not write it keeps remains, on which it crashes as a process ends that others use it in,
  // too.
  try {
    driver(base).file->write(offset, {static_cast<const std::byte*>(buffer), size});
  } catch (const std::exception& error) {
    driver(base).file->note_failure(error.what());
  }
  return 0;
}

hid_t driver_id() {
  static const H5FD_class_t driver_class = [] {
    H5FD_class_t made{};
    made.name = "leapmap_journaled";
    made.maxaddr = (haddr_t{1} << 63) - 1;
    made.fc_degree = H5F_CLOSE_WEAK;
    made.fapl_size = sizeof(Target);
    made.fapl_get = access_of;
    made.open = open;
    made.close = close;
    made.query = query;
    made.get_eoa = get_eoa;
    made.set_eoa = set_eoa;
    made.get_eof = get_eof;
    made.read = read;
    made.write = write;
    const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;  // raw data and metadata aggregate apart, as HDF5's own do
    std::copy(std::begin(map), std::end(map), made.fl_map);
    return made;
  }();
  static const hid_t id = H5FDregister(&driver_class);
  return id;
}

/// Valid while `file` and `sources` are.
Handle access_to(const std::shared_ptr<JournaledFile>& file,
                 const std::shared_ptr<const SourceNames>& sources) {
  initialise();
  const Target target{&file, &sources};
  const std::string& path = file->path();
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path);
  check(H5Pset_driver(access, driver_id(), &target), path);
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), path);  // nothing may write after we have closed
  if (file->access() != JournaledFile::Access::read)  // a map that others have repacked may be read as well
    check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110), path);  // 1.10: virtual datasets
  return access;
}

Handle creation_of(const std::string& path) {
  Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, path);
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path);
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), path);
  return creation;
}

enum class Mode {
  read,
  change,
  verify,  ///< to be read by whoever has just written it
};

/// The mode is no flag of HDF5's: those are macros that initialise the library, with its handler at exit,
/// before initialise() can keep it away.
Handle open_in(const std::shared_ptr<JournaledFile>& file, Mode mode) {
  const auto sources = std::make_shared<SourceNames>();
  const std::shared_ptr<const SourceNames> seen = sources;
  const Handle access = access_to(file, seen);
  const std::string& path = file->path();
  try {
    Handle opened(H5Fopen(path.c_str(), mode == Mode::change ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access),
                  H5Fclose, path + ": cannot be read as HDF5");
    if (mode == Mode::verify) return opened;
    *sources = refuse_foreign_parts(opened, path);
    if (!sources->empty() && mode == Mode::change)
      throw ForeignFile(path +
                        ": its values are in shards; allowed: a map of leapmap join without --virtual");
    return opened;
  } catch (const ForeignFile&) {
    throw;
  } catch (const IoError& error) {
    file->rethrow_failure();  // it is the system that failed
    throw BrokenFile(error.what());
  }
}

enum class Beginning { other, hdf5, unfinished };

/// How a file begins: as HDF5 files do, or with zeros in place of some of that, as one does that was never
/// flushed.
Beginning beginning_of(const JournaledFile& file) {
  constexpr std::array signature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, signature.size()> first{};
  const auto size =
      static_cast<std::size_t>(std::min<std::uint64_t>(first.size(), file.end()));  // it may be cut
  file.read(0, std::as_writable_bytes(std::span(first).first(size)));
  if (std::equal(first.data(), first.data() + size, signature.data())) return Beginning::hdf5;
  const auto may_become = [](char now, char then) { return now == 0 || now == then; };
  const bool of_ours =
      size < first.size() ? first == decltype(first){} : std::ranges::equal(first, signature, may_become);
  return of_ours ? Beginning::unfinished : Beginning::other;
}

Beginning beginning_of(const std::string& path, Locking locking) {
  return beginning_of(JournaledFile(path, JournaledFile::Access::read, locking));  // its journal may hold it
}

/// What a file says it is. Throws BrokenFile if that cannot be told, IoError if the system fails.
std::optional<std::string> filetype_of(const std::string& path, Locking locking) {
  const File file = File::open(path, locking);
  try {
    return has_attribute(file, "filetype") ? std::optional(read_text(file, "filetype")) : std::nullopt;
  } catch (const IoError& error) {
    file.bytes().rethrow_failure();
    throw BrokenFile(fmt::format("{}: is damaged: {}", path, error.what()));
  }
}

}  // namespace

bool is_hdf5(const std::string& path, Locking locking) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && beginning_of(path, locking) != Beginning::other;
}

File File::create(const std::string& path, std::string_view filetype, Locking locking) {
  make_folder(folder_of(path));
  refuse_other_unfinished(path, filetype, locking);
  File file(std::make_shared<JournaledFile>(path, JournaledFile::Access::create, locking));
  const std::shared_ptr<const SourceNames> none;
  const Handle access = access_to(file.bytes_, none), creation = creation_of(path);
  file.handle_ = {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose,
                  path + ": cannot be created"};
  file.bytes_->rethrow_failure();
  return file;
}

File File::open(const std::string& path, Locking locking) {
  File file(std::make_shared<JournaledFile>(path, JournaledFile::Access::read, locking));
  if (beginning_of(*file.bytes_) == Beginning::unfinished)
    throw BrokenFile(path +
                     ": holds nothing, as what wrote it was stopped before its first commit; allowed: start "
                     "it again");
  file.handle_ = open_in(file.bytes_, Mode::read);
  return file;
}

File File::change(const std::string& path, Locking locking) {
  File file(std::make_shared<JournaledFile>(path, JournaledFile::Access::change, locking));
  file.handle_ = open_in(file.bytes_, Mode::change);
  file.flush();  // cuts off what was written after the last one
  return file;
}

std::optional<File> File::copy(const JournaledFile& original, const std::string& to,
                               std::string_view filetype, Locking locking,
                               const std::function<bool()>& stop_requested) {
  if (!original.seal_holds().value_or(true))
    throw BrokenFile(original.path() + ": is damaged: its bytes differ from what was written");
  refuse_other_unfinished(to, filetype, locking);
  File file(std::make_shared<JournaledFile>(to, JournaledFile::Access::create, locking));
  try {
    std::vector<std::byte> bytes(std::size_t{1} << 20);
    for (std::uint64_t offset = 0; offset < original.end(); offset += bytes.size()) {
      if (stop_requested && stop_requested()) {
        file.discard();
        return std::nullopt;
      }
      bytes.resize(std::min<std::uint64_t>(bytes.size(), original.end() - offset));
      original.read(offset, bytes);
      file.bytes_->write(offset, bytes);
    }
    file.bytes_->resize(original.end());
    std::error_code ignored;
    std::filesystem::permissions(to, std::filesystem::status(original.path(), ignored).permissions(),
                                 ignored);
    file.handle_ = open_in(file.bytes_, Mode::change);
  } catch (...) {
    file.discard();
    throw;
  }
  return file;
}

bool File::blank(const std::string& path, Locking locking) {
  return JournaledFile(path, JournaledFile::Access::read, locking).blank();
}

File& File::operator=(File&& other) noexcept {
  abandon();
  bytes_ = std::move(other.bytes_);
  handle_ = std::move(other.handle_);
  return *this;
}

File::~File() { abandon(); }

void File::flush() {
  check(H5Fflush(handle_, H5F_SCOPE_LOCAL), bytes_->path() + ": cannot be written");
  bytes_->commit();
}

void File::close() {
  handle_.close(bytes_->path() + ": cannot be written");
  bytes_->commit();
}

void refuse_other_file(const std::string& path, std::string_view filetype, Locking locking) {
  std::error_code ignored;
  const auto there = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(there)) return;
  if (std::filesystem::is_directory(there)) throw InputError(path + ": is a folder; allowed: a file's name");
  bool same = std::filesystem::is_regular_file(there);
  try {
    if (same && std::filesystem::file_size(path, ignored) > 0) same = filetype_of(path, locking) == filetype;
  } catch (const BrokenFile&) {
    same = false;
  }
  if (!same)
    throw InputError(
        fmt::format("{}: exists and is not a {}, or is damaged; allowed: another name, or that of "
                    "an older one",
                    path, filetype));
}

void refuse_other_unfinished(const std::string& path, std::string_view filetype, Locking locking) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored) || std::filesystem::file_size(path, ignored) == 0)
    return;
  bool ours = true;
  try {
    const Beginning beginning = beginning_of(path, locking);
    ours = beginning == Beginning::unfinished ||
           (beginning == Beginning::hdf5 && filetype_of(path, locking) == filetype);
  } catch (const ForeignFile&) {
    throw;
  } catch (const BrokenFile&) {  // ours to begin anew
  }
  if (!ours)
    throw InputError(fmt::format(
        "{}: exists and is not an unfinished {}; allowed: another name, or remove it", path, filetype));
}

bool File::finish(const std::string& path, bool replace, const std::function<void(hid_t)>& verify,
                  const std::function<void()>& committed) {
  handle_.close(bytes_->path() + ": cannot be written");
  JournaledFile& bytes = *bytes_;
  bytes.rethrow_failure();
  const std::uint64_t size = bytes.size();
  // While HDF5 reads a long file again, one thread syncs it and another makes its checksum, if there can be
  // any. Whatever this finds, what was written is committed. For a shorter file threads take longer.
  const bool is_long = size >= std::uint64_t{1} << 20;
  const auto launch = is_long ? std::launch::async | std::launch::deferred : std::launch::deferred;
  std::future<std::uint32_t> checksum;
  std::future<void> synced;
  std::exception_ptr wrong;
  try {
    if (is_long) synced = std::async(launch, [&] { bytes.sync_appended(); });
    checksum = std::async(launch, [&, size] { return bytes.checksum(size); });
    Handle written = open_in(bytes_, Mode::verify);
    verify(written);
    written.close(bytes_->path() + ": cannot be read");
  } catch (...) {
    wrong = std::current_exception();
  }
  bytes.forget_failure();
  bytes.resize(size);  // HDF5 moves the end as it opens a file
  if (checksum.valid()) checksum.wait();
  try {
    if (synced.valid()) synced.get();
  } catch (const std::exception& error) {
    bytes.note_failure(error.what());
  }
  bytes.commit();
  committed();
  if (wrong) std::rethrow_exception(wrong);
  bytes.seal(checksum.get());
  const bool durable = bytes.rename(path, replace);
  bytes_.reset();
  return durable;
}

void File::discard() {
  if (bytes_) bytes_->unlink();  // while it is still ours
  abandon();
}

void File::abandon() {
  if (!bytes_) return;
  bytes_->abandon();
  handle_ = {};  // nothing reaches the file any more, so that nothing can go wrong
  bytes_.reset();
}

}  // namespace leapmap::hdf5
