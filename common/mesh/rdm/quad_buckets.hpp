// QuadBuckets: finished quads by direction and layer, in the order in which they were closed. A sweep closes
// quads of all layers in turn; a bucket a layer makes the mesh a plain concatenation, without a sort.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/quad.hpp"
#include "common/runs/extent.hpp"

namespace runstone::rdm {

class QuadBuckets {
 public:
  void put(Direction direction, std::uint32_t layer, Quad quad) {
    Bucket& bucket = buckets_[static_cast<std::size_t>(direction) * kSideMax + layer];
    if (bucket.count == bucket.room) grow(bucket);
    bucket.quads[bucket.count++] = quad;
  }

  /// Replaces `out` by all quads put since the last call, and forgets them. `sides` of the chunk, by axis.
  /// O(quads + layers).
  void finish(const std::array<std::uint8_t, 3>& sides, QuadLayers& out) {
    std::size_t total = 0;
    for_each_layer(sides, [&](std::size_t at) { total += buckets_[at].count; });
    out.quads.resize(total + kStep);  // room for whole steps; the vector keeps it
    Quad* to = out.quads.data();
    std::size_t filled = 0;
    std::size_t next = 0;
    for_each_layer(sides, [&](std::size_t at) {
      for (; next <= at; ++next) out.first[next] = static_cast<std::uint32_t>(filled);
      Bucket& bucket = buckets_[at];
      for (std::size_t i = 0; i < bucket.count; i += kStep) {
        std::copy_n(bucket.quads.get() + i, kStep, to + filled + i);
      }
      filled += bucket.count;
      bucket.count = 0;
    });
    for (; next < out.first.size(); ++next) out.first[next] = static_cast<std::uint32_t>(filled);
    out.quads.resize(total);
  }

 private:
  static constexpr std::size_t kStep = 4;  // quads copied at once
  struct Bucket {
    std::unique_ptr<Quad[]> quads;
    std::uint32_t count = 0;
    std::uint32_t room = 0;  // a multiple of kStep
  };

  static void grow(Bucket& bucket) {
    const std::uint32_t room = bucket.room == 0 ? 32 : bucket.room * 2;
    auto quads = std::make_unique<Quad[]>(room);
    std::copy_n(bucket.quads.get(), bucket.count, quads.get());
    bucket.quads = std::move(quads);
    bucket.room = room;
  }

  template <class F>
  static void for_each_layer(const std::array<std::uint8_t, 3>& sides, F&& visit) {
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      for (std::size_t layer = 0; layer < sides[d / 2]; ++layer) visit(d * kSideMax + layer);
    }
  }

  std::array<Bucket, kDirectionCount * kSideMax> buckets_;
};

}  // namespace runstone::rdm
