// RunList: the runs of one chunk in the narrowest form that holds its ends.
//   volume <= 65,535: one vector of PackedRun (u16 end, u16 material), 4 bytes a run
//   larger:           two vectors (u32 ends, u16 materials), 6 bytes a run
// Both forms are also the bytes of the `raw` wire encoding, so a snapshot is read in place. A
// RunList does not check that its runs are canonical; RunChunk's validate() and RunBuilder do.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/ids.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

/// A run by value: it covers [end of the previous run, end).
struct Run {
  std::uint32_t end = 0;
  Material material = kEmpty;
  friend bool operator==(const Run&, const Run&) = default;
};

struct PackedRun {
  std::uint16_t end = 0;
  Material material = kEmpty;
  friend bool operator==(const PackedRun&, const PackedRun&) = default;
};
static_assert(sizeof(PackedRun) == 4);

inline constexpr std::uint32_t kNarrowVolumeMax = 65535;

/// Two read-only views with one interface. Hot code is a template over the view, so that the branch
/// on the form is outside its loop.
class NarrowRuns {
 public:
  explicit NarrowRuns(std::span<const PackedRun> runs) : runs_(runs) {}
  std::size_t size() const { return runs_.size(); }
  std::uint32_t end(std::size_t i) const { return runs_[i].end; }
  Material material(std::size_t i) const { return runs_[i].material; }
  std::span<const PackedRun> packed() const { return runs_; }
  /// Returns a view of `count` runs from run `first` on. Their ends stay as they are.
  NarrowRuns part(std::size_t first, std::size_t count) const {
    return NarrowRuns(runs_.subspan(first, count));
  }

 private:
  std::span<const PackedRun> runs_;
};

class WideRuns {
 public:
  WideRuns(std::span<const std::uint32_t> ends, std::span<const Material> materials)
      : ends_(ends), materials_(materials) {}
  std::size_t size() const { return ends_.size(); }
  std::uint32_t end(std::size_t i) const { return ends_[i]; }
  Material material(std::size_t i) const { return materials_[i]; }
  std::span<const std::uint32_t> ends() const { return ends_; }
  std::span<const Material> materials() const { return materials_; }
  /// Returns a view of `count` runs from run `first` on. Their ends stay as they are.
  WideRuns part(std::size_t first, std::size_t count) const {
    return {ends_.subspan(first, count), materials_.subspan(first, count)};
  }

 private:
  std::span<const std::uint32_t> ends_;
  std::span<const Material> materials_;
};

class RunList {
 public:
  /// Makes an empty list in the form that `volume` requires.
  explicit RunList(std::uint32_t volume = 0);
  /// Takes vectors that a decoder filled. They are not checked: validate() the chunk.
  static RunList of_narrow(std::vector<PackedRun> runs);
  /// Requires as many ends as materials.
  static RunList of_wide(std::vector<std::uint32_t> ends, std::vector<Material> materials);

  bool is_narrow() const { return std::holds_alternative<Narrow>(form_); }
  std::size_t size() const;
  std::uint32_t end(std::size_t i) const;
  Material material(std::size_t i) const;
  Run operator[](std::size_t i) const { return {end(i), material(i)}; }
  /// Returns the first voxel of run i.
  std::uint32_t begin(std::size_t i) const { return i == 0 ? 0 : end(i - 1); }

  void clear();
  void reserve(std::size_t runs);
  /// Requires run.end to fit the form. Does not merge.
  void push_back(Run run);
  /// Replaces runs [first, first + count) by `with`. Cost: O(runs behind them).
  void splice(std::size_t first, std::size_t count, std::span<const Run> with);

  /// Calls f with NarrowRuns or WideRuns. The view is invalid after the call.
  template <class F>
  decltype(auto) visit(F&& f) const {
    if (const auto* narrow = std::get_if<Narrow>(&form_))
      return std::forward<F>(f)(NarrowRuns{*narrow});
    const auto& wide = *std::get_if<Wide>(&form_);
    return std::forward<F>(f)(WideRuns{wide.ends, wide.materials});
  }

  /// Returns the bytes of run storage in use (4 or 6 a run), without spare capacity.
  std::size_t byte_size() const { return size() * (is_narrow() ? 4 : 6); }
  /// Returns the bytes of run storage allocated, spare capacity included.
  std::size_t byte_capacity() const;
  void shrink_to_fit();

  friend bool operator==(const RunList&, const RunList&) = default;

 private:
  using Narrow = std::vector<PackedRun>;
  struct Wide {
    std::vector<std::uint32_t> ends;
    std::vector<Material> materials;
    friend bool operator==(const Wide&, const Wide&) = default;
  };
  std::variant<Narrow, Wide> form_;
};

}  // namespace runstone
