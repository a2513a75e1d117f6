// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <functional>
#include <numeric>

#include "audit/audit_report.hpp"
#include "leapmap/map.hpp"
#include "map/reader.hpp"
#include "spec/map_spec.hpp"

namespace leapmap {

Map::Map(const std::string& path, bool lock)
    : path_(path),
      reader_(std::make_unique<MapReader>(path, lock ? Locking::required : Locking::if_possible)) {}
Map::~Map() = default;
Map::Map(Map&&) noexcept = default;
Map& Map::operator=(Map&&) noexcept = default;

std::vector<Axis> Map::axes() const {
  std::vector<Axis> axes;
  if (!reader_->is_list())
    for (const MapReader::Dimension& dimension : reader_->dimensions())
      axes.push_back({dimension.name, dimension.values});
  return axes;
}

std::vector<std::size_t> Map::shape() const { return reader_->shape(); }
std::vector<std::string> Map::fields() const { return reader_->fields(); }
std::vector<std::string> Map::labels() const { return reader_->labels(); }
std::string Map::unit(const std::string& field) const { return reader_->unit(field); }

std::vector<double> Map::read(const std::string& field) const {
  const std::vector<std::size_t> all = shape();
  return read(field, std::vector<std::size_t>(all.size(), 0), all);
}

std::vector<double> Map::read(const std::string& field, const std::vector<std::size_t>& start,
                              const std::vector<std::size_t>& extent) const {
  if (!reader_->has(field))
    throw InputError(
        fmt::format("{}: has no field '{}'; allowed: {}", path_, field, fmt::join(fields(), ", ")));
  const std::vector<std::size_t> all = shape();
  bool inside = start.size() == all.size() && extent.size() == all.size();
  for (std::size_t i = 0; inside && i < all.size(); ++i)
    inside = start[i] <= all[i] && extent[i] <= all[i] - start[i];
  if (!inside)
    throw InputError(fmt::format("{}: the block at ({}) of size ({}) is outside; allowed: within ({})", path_,
                                 fmt::join(start, ", "), fmt::join(extent, ", "), fmt::join(all, ", ")));
  return reader_->read(
      field,
      {start, extent, std::accumulate(extent.begin(), extent.end(), std::size_t{1}, std::multiplies<>())});
}

bool Map::is_whole() const { return reader_->is_whole(); }
StatusCounts Map::status_counts() const { return reader_->status_counts(); }
Spec Map::spec() const {
  Spec spec = spec_of(*reader_, path_);
  spec.origin.clear();  // the map is no input of a sweep by it
  return spec;
}

std::string Map::attribute(const std::string& name) const { return reader_->attribute(name); }

std::optional<AuditReport> Map::audit() const {
  if (!hdf5::has_attribute(reader_->file(), "audit_first_mismatch")) return std::nullopt;
  return read_audit(*reader_);
}

}  // namespace leapmap
