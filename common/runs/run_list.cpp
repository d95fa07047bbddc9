#include "common/runs/run_list.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

RunList::RunList(std::uint32_t volume) {
  if (volume > kNarrowVolumeMax) form_.emplace<Wide>();
}

RunList RunList::of_narrow(std::vector<PackedRun> runs) {
  RunList list;
  list.form_.emplace<Narrow>(std::move(runs));
  return list;
}

RunList RunList::of_wide(std::vector<std::uint32_t> ends, std::vector<Material> materials) {
  RUNSTONE_ASSERT(ends.size() == materials.size());
  RunList list;
  list.form_.emplace<Wide>(Wide{std::move(ends), std::move(materials)});
  return list;
}

std::size_t RunList::size() const {
  return visit([](const auto& runs) { return runs.size(); });
}
std::uint32_t RunList::end(std::size_t i) const {
  return visit([i](const auto& runs) { return runs.end(i); });
}
Material RunList::material(std::size_t i) const {
  return visit([i](const auto& runs) { return runs.material(i); });
}

void RunList::clear() {
  if (auto* narrow = std::get_if<Narrow>(&form_)) return narrow->clear();
  auto& wide = *std::get_if<Wide>(&form_);
  wide.ends.clear();
  wide.materials.clear();
}

void RunList::reserve(std::size_t runs) {
  if (auto* narrow = std::get_if<Narrow>(&form_)) return narrow->reserve(runs);
  auto& wide = *std::get_if<Wide>(&form_);
  wide.ends.reserve(runs);
  wide.materials.reserve(runs);
}

void RunList::push_back(Run run) {
  if (auto* narrow = std::get_if<Narrow>(&form_)) {
    RUNSTONE_DASSERT(run.end <= kNarrowVolumeMax);
    narrow->push_back({static_cast<std::uint16_t>(run.end), run.material});
    return;
  }
  auto& wide = *std::get_if<Wide>(&form_);
  wide.ends.push_back(run.end);
  wide.materials.push_back(run.material);
}

namespace {

// Overwrites the part that both ranges have, then inserts or erases the difference: the tail moves
// once.
template <class Vector, class Get>
void splice_vector(Vector& v, std::size_t first, std::size_t count, std::span<const Run> with,
                   Get get) {
  const std::size_t shared = std::min(count, with.size());
  for (std::size_t i = 0; i < shared; ++i) v[first + i] = get(with[i]);
  const auto tail = v.begin() + static_cast<std::ptrdiff_t>(first + shared);
  if (count > shared) {
    v.erase(tail, tail + static_cast<std::ptrdiff_t>(count - shared));
  } else if (with.size() > shared) {
    const std::size_t extra = with.size() - shared;
    const auto at = v.insert(tail, extra, typename Vector::value_type{});
    for (std::size_t i = 0; i < extra; ++i)
      at[static_cast<std::ptrdiff_t>(i)] = get(with[shared + i]);
  }
}

}  // namespace

void RunList::splice(std::size_t first, std::size_t count, std::span<const Run> with) {
  RUNSTONE_DASSERT(first + count <= size());
  if (auto* narrow = std::get_if<Narrow>(&form_)) {
    splice_vector(*narrow, first, count, with, [](const Run& r) {
      return PackedRun{static_cast<std::uint16_t>(r.end), r.material};
    });
    return;
  }
  auto& wide = *std::get_if<Wide>(&form_);
  splice_vector(wide.ends, first, count, with, [](const Run& r) { return r.end; });
  splice_vector(wide.materials, first, count, with, [](const Run& r) { return r.material; });
}

std::size_t RunList::byte_capacity() const {
  if (const auto* narrow = std::get_if<Narrow>(&form_))
    return narrow->capacity() * sizeof(PackedRun);
  const auto& wide = *std::get_if<Wide>(&form_);
  return wide.ends.capacity() * sizeof(std::uint32_t) +
         wide.materials.capacity() * sizeof(Material);
}

void RunList::shrink_to_fit() {
  if (auto* narrow = std::get_if<Narrow>(&form_)) return narrow->shrink_to_fit();
  auto& wide = *std::get_if<Wide>(&form_);
  wide.ends.shrink_to_fit();
  wide.materials.shrink_to_fit();
}

}  // namespace runstone
