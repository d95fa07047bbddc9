#include "common/model_writers/corner_set.hpp"

#include <algorithm>

namespace runstone {
namespace {

static_assert((kRegionPoints - 1) * kModelUnits < 1U << 12);  // a place along an axis fits a key

bool is_lattice(int place) { return place % kModelUnits == 0; }

}  // namespace

std::uint64_t CornerSet::key_of(const Corner& at, std::size_t axis) {
  const auto share = [&](std::size_t of, unsigned shift) {
    return static_cast<std::uint64_t>(at[of]) << shift;
  };
  return share(axis, 0) | share((axis + 1) % 3, kKeyBits) | share((axis + 2) % 3, 2 * kKeyBits);
}

void CornerSet::clear() {
  lattice_.clear();
  for (std::vector<std::uint64_t>& line : lines_) line.clear();
}

CornerSet::Added CornerSet::add(const Corner& at) {
  if (is_lattice(at[0]) && is_lattice(at[1]) && is_lattice(at[2])) {
    const bool is_new =
        lattice_.add({at[0] / kModelUnits, at[1] / kModelUnits, at[2] / kModelUnits});
    return is_new ? Added::on_lattice : Added::known;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) lines_[axis].push_back(key_of(at, axis));
  return Added::off_lattice;
}

void CornerSet::finish() {
  for (std::vector<std::uint64_t>& line : lines_) {
    std::sort(line.begin(), line.end());
    line.erase(std::unique(line.begin(), line.end()), line.end());
  }
}

void CornerSet::distances_between(const Corner& from, const Corner& to,
                                  std::vector<int>& out) const {
  out.clear();
  std::size_t axis = 0;
  while (from[axis] == to[axis]) ++axis;
  const int low = std::min(from[axis], to[axis]), high = std::max(from[axis], to[axis]);
  const auto add = [&](int place) { out.push_back(place - low); };
  Corner at = from;
  if (is_lattice(at[(axis + 1) % 3]) && is_lattice(at[(axis + 2) % 3])) {
    for (std::size_t i = 0; i < 3; ++i) at[i] /= kModelUnits;
    const auto voxel = [](int place) { return place / kModelUnits; };
    for (at[axis] = voxel(low) + 1; at[axis] * kModelUnits < high; ++at[axis]) {
      if (lattice_.has(at)) add(at[axis] * kModelUnits);
    }
  }
  const std::vector<std::uint64_t>& line = lines_[axis];
  if (!line.empty()) {
    at = from;
    at[axis] = high;
    const std::uint64_t end = key_of(at, axis);
    at[axis] = low;
    for (auto key = std::upper_bound(line.begin(), line.end(), key_of(at, axis));
         key != line.end() && *key < end; ++key)
      add(part(*key, 0));
    std::sort(out.begin(), out.end());
  }
  if (to[axis] < from[axis]) {
    std::reverse(out.begin(), out.end());
    for (int& distance : out) distance = high - low - distance;
  }
}

}  // namespace runstone
