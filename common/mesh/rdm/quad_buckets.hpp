// QuadBuckets: finished quads by direction and layer, in the order in which they were closed. A
// sweep closes quads of all layers in turn. With a bucket per layer the mesh is a concatenation,
// without a sort.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/quad.hpp"
#include "common/runs/extent.hpp"

namespace runstone::rdm {

class QuadBuckets {
 public:
  /// The quads of one layer.
  struct Bucket {
    std::unique_ptr<Quad[]> quads;
    std::uint32_t count = 0;
    std::uint32_t room = 0;  // a multiple of kStep
  };

  /// Returns the buckets of one direction, by layer.
  Bucket* of(Direction direction) {
    return buckets_.data() + static_cast<std::size_t>(direction) * kSideMax;
  }
  static void put(Bucket& bucket, Quad quad) {
    if (bucket.count == bucket.room) grow(bucket);
    bucket.quads[bucket.count++] = quad;
  }
  /// Makes room for `more` quads and returns the place of the first. The caller writes them and
  /// adds them to `count`.
  static Quad* reserve(Bucket& bucket, std::uint32_t more) {
    while (bucket.room - bucket.count < more) grow(bucket);
    return bucket.quads.get() + bucket.count;
  }

  /// Replaces `out` by all quads put since the last call, and forgets them. `sides`: of the chunk,
  /// by axis. Cost: O(quads + layers).
  void finish(const std::array<std::uint8_t, 3>& sides, QuadLayers& out) {
    std::size_t total = 0;
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      for (std::size_t i = d * kSideMax; i < d * kSideMax + sides[d / 2]; ++i)
        total += buckets_[i].count;
    }
    out.quads.resize(total + kStep);  // room for whole steps; the vector keeps it
    Quad* to = out.quads.data();
    std::uint32_t* const first = out.first.data();
    std::uint32_t filled = 0;
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const std::size_t end = d * kSideMax + sides[d / 2];
      for (std::size_t at = d * kSideMax; at < end; ++at) {
        first[at] = filled;
        Bucket& bucket = buckets_[at];
        const std::uint32_t count = bucket.count;
        const Quad* const from = bucket.quads.get();
        for (std::uint32_t i = 0; i < count; i += kStep) {
          std::memcpy(to + filled + i, from + i, kStep * sizeof(Quad));
        }
        filled += count;
        bucket.count = 0;
      }
      std::fill(first + end, first + (d + 1) * kSideMax, filled);
    }
    first[kDirectionCount * kSideMax] = filled;
    out.quads.resize(total);
  }

  /// Doubles the room of a bucket.
  static void grow(Bucket& bucket) {
    const std::uint32_t room = bucket.room == 0 ? 32 : bucket.room * 2;
    auto quads = std::make_unique<Quad[]>(room);
    std::copy_n(bucket.quads.get(), bucket.count, quads.get());
    bucket.quads = std::move(quads);
    bucket.room = room;
  }

 private:
  static constexpr std::size_t kStep = 4;  // quads copied at once

  std::array<Bucket, kDirectionCount * kSideMax> buckets_;
};

}  // namespace runstone::rdm
