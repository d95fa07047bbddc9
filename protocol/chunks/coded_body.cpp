#include "protocol/chunks/coded_body.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "common/core/assert.hpp"
#include "protocol/chunks/codec_scratch.hpp"
#include "protocol/chunks/range_coder.hpp"
#include "protocol/chunks/read_runs.hpp"
#include "protocol/chunks/wire_palette.hpp"

namespace runstone {
namespace {

constexpr std::size_t kScratchRunsKept = 1 << 17;  // more are freed after a huge chunk

/// A run with its material as an index into the palette.
struct IndexRun {
  std::uint32_t end = 0;
  std::uint32_t index = 0;
};

/// Models of a number below 2^21, written in a given number of bits, high bits first. A number of
/// few bits has a model for every prefix.
struct NumberModel {
  static constexpr unsigned kTreeBitsMax = 5;
  std::array<AdaptiveBit, 2u << kTreeBitsMax> tree;
  std::array<AdaptiveBit, 22> deep;  // by the place of the bit
};

struct Models {
  // docs/protocol.md names the models S, N, T and U, G, H, K, I, J, in this order.
  std::array<AdaptiveBit, 256> start;         // a change at the start of a stretch
  std::array<AdaptiveBit, 64 * 6> inside;     // a change within a stretch
  std::array<NumberModel, 4> distance;        // of a change within a stretch
  std::array<AdaptiveBit, 3> above;           // the new material is the one above
  AdaptiveBit behind, follower;               // it is the one behind; it is the follower
  std::array<AdaptiveBit, 256> material;      // the first eight bits of a palette index, by prefix
  std::array<AdaptiveBit, 16> material_deep;  // the further bits, by place
};

struct Scratch {
  Models models;
  std::vector<IndexRun> runs;
  std::vector<std::uint16_t> follower;  // by palette index
  std::vector<std::uint8_t> used;       // by palette index
  WirePalette palette;
  Bytes bytes;
};

Scratch& scratch() {
  thread_local Scratch mine;
  return mine;
}

/// The runs that an encoder reads.
template <class Runs>
class Known {
 public:
  Known(const Runs& runs, const WirePalette& palette) : runs_(runs), palette_(palette) {}
  std::uint32_t end() const { return runs_.end(at_); }
  std::uint32_t index() const { return palette_.index_of(runs_.material(at_)); }
  void next() { ++at_; }

 private:
  const Runs& runs_;
  const WirePalette& palette_;
  std::size_t at_ = 0;
};

/// Takes the place of Known in a decoder, whose coder ignores it.
struct Unknown {
  static std::uint32_t end() { return 0; }
  static std::uint32_t index() { return 0; }
  static void next() {}
};

/// Encodes or decodes one chunk: `Coder` takes each bit from `Truth` or from bytes. So both
/// directions have the same models and the same list of runs.
template <class Coder, class Truth>
class RunCoder {
 public:
  RunCoder(Coder coder, Truth truth, Scratch& s, OrderedExtent extent, std::size_t materials)
      : coder_(coder),
        truth_(truth),
        m_(s.models),
        runs_(s.runs),
        follower_(s.follower),
        line_(extent.f),
        layer_(extent.layer()),
        volume_(extent.volume()),
        materials_(static_cast<std::uint32_t>(materials)),
        material_bits_(static_cast<unsigned>(std::bit_width(materials - 1))) {
    m_ = Models{};
    runs_.clear();
    follower_.assign(materials, 0);
  }

  Result<void> run() {
    now_ = code_material();
    if (now_ >= materials_) return broken("palette index behind the palette");
    runs_.push_back({volume_, now_});
    above_ = behind_ = first_ = now_;
    for (std::uint32_t at = 0; at < volume_;) {
      const std::uint32_t above_before = above_, behind_before = behind_;
      look(at);
      std::uint32_t stop = stretch_end();
      if (at > 0) {
        const std::uint32_t meets =
            same(now_, above_) | same(now_, behind_) << 1 | same(above_, behind_) << 2 |
            same(now_, above_before) << 3 | same(now_, behind_before) << 4 |
            same(above_, above_before) << 5 | same(behind_, behind_before) << 6;
        const std::uint32_t context = meets << 1 | (stop - at > 1 ? 1 : 0);
        if (coder_.code(m_.start[context], truth_.end() == at)) {
          truth_.next();
          if (const auto changed = change(at); !changed) return changed;
        }
      }
      bool again = false;
      for (std::uint32_t from = at;; again = true) {
        stop = stretch_end();
        const std::uint32_t left = stop - from;
        if (left < 2) break;
        const std::uint32_t meets = same(now_, above_) | same(now_, behind_) << 1 |
                                    same(above_, behind_) << 2 | same(above_end_, stop) << 3 |
                                    same(behind_end_, stop) << 4 | (again ? 1u : 0u) << 5;
        const auto size = std::min(static_cast<std::uint32_t>(std::bit_width(left)) - 1, 5u);
        if (!coder_.code(m_.inside[meets * 6 + size], truth_.end() < stop)) break;
        const std::uint32_t skipped = code_distance(truth_.end() - from - 1, left - 2);
        if (skipped > left - 2) return broken("run ends behind its stretch");
        from += skipped + 1;
        truth_.next();
        if (const auto changed = change(from); !changed) return changed;
      }
      at = stop;
      if (coder_overrun()) return cut();
    }
    return {};
  }

  auto finish() { return coder_.finish(); }

 private:
  static std::uint32_t same(std::uint32_t a, std::uint32_t b) { return a == b ? 1 : 0; }
  /// Returns the error, or truncated if the coder read beyond the body: then the runs are
  /// arbitrary.
  Result<void> broken(const char* what) const {
    return coder_overrun() ? cut() : fail(ErrorCode::not_canonical, what);
  }
  static Result<void> cut() { return fail(ErrorCode::truncated, "body ends inside its runs"); }

  bool coder_overrun() const {
    if constexpr (requires { coder_.overrun(); }) return coder_.overrun();
    return false;
  }

  /// Finds the materials above and behind voxel `at`, one line and one layer before it. In the
  /// first line, the one above is the first material. In the first layer, the one behind is the one
  /// above.
  void look(std::uint32_t at) {
    above_ = first_;
    if (at >= line_) {
      while (runs_[above_run_].end <= at - line_) ++above_run_;
      above_ = runs_[above_run_].index;
    }
    behind_ = above_;
    if (at >= layer_) {
      while (runs_[behind_run_].end <= at - layer_) ++behind_run_;
      behind_ = runs_[behind_run_].index;
    }
    at_ = at;
  }

  /// Returns the first position at which the material above or behind may change, or the volume.
  /// The open run has no end yet and counts as endless.
  std::uint32_t stretch_end() {
    above_end_ = at_ < line_ ? line_ : runs_[above_run_].end + line_;
    behind_end_ = at_ < layer_ ? layer_ : runs_[behind_run_].end + layer_;
    return std::min({above_end_, behind_end_, volume_});
  }

  /// Ends the open run before `at` and opens one of another material.
  Result<void> change(std::uint32_t at) {
    const std::uint32_t before = now_;
    if (!code_change()) return broken("material is written in a longer way than needed");
    runs_.back().end = at;
    runs_.push_back({volume_, now_});
    RUNSTONE_DASSERT(now_ != before);
    static_cast<void>(before);
    return {};
  }

  bool code_change() {
    const std::uint32_t next = truth_.index(), before = now_;
    if (above_ != before) {
      const std::uint32_t context = same(behind_, above_) | same(behind_, before) << 1;
      if (coder_.code(m_.above[context], next == above_)) {
        now_ = above_;
        return true;
      }
    }
    if (behind_ != before && behind_ != above_ && coder_.code(m_.behind, next == behind_)) {
      now_ = behind_;
      return true;
    }
    const std::uint32_t follower = follower_[before];
    const bool follows = follower != before && follower != above_ && follower != behind_;
    if (follows && coder_.code(m_.follower, next == follower)) {
      now_ = follower;
      return true;
    }
    now_ = code_material();
    if (now_ >= materials_ || now_ == before || now_ == above_ || now_ == behind_ ||
        now_ == follower)
      return false;
    follower_[before] = static_cast<std::uint16_t>(now_);
    return true;
  }

  std::uint32_t code_material() {
    const std::uint32_t truth = truth_.index();
    std::uint32_t prefix = 1;
    for (unsigned bit = material_bits_; bit-- > 0;) {
      AdaptiveBit& model = prefix < 256 ? m_.material[prefix] : m_.material_deep[bit];
      prefix = prefix << 1 | (coder_.code(model, (truth >> bit & 1) != 0) ? 1 : 0);
    }
    return prefix - (1u << material_bits_);
  }

  /// Codes a number of 0 .. max in as many bits as max has.
  std::uint32_t code_distance(std::uint32_t truth, std::uint32_t max) {
    const auto bits = static_cast<unsigned>(std::bit_width(max));
    NumberModel& model = m_.distance[same(now_, above_) | same(now_, behind_) << 1];
    std::uint32_t prefix = 1;
    for (unsigned bit = bits; bit-- > 0;) {
      AdaptiveBit& one = bits <= NumberModel::kTreeBitsMax ? model.tree[(1u << bits) - 1 + prefix]
                                                           : model.deep[bit];
      prefix = prefix << 1 | (coder_.code(one, (truth >> bit & 1) != 0) ? 1 : 0);
    }
    return prefix - (1u << bits);
  }

  Coder coder_;
  Truth truth_;
  Models& m_;
  std::vector<IndexRun>& runs_;  // the last one is open: its end is the volume until a change
  std::vector<std::uint16_t>& follower_;
  const std::uint32_t line_, layer_, volume_, materials_;
  const unsigned material_bits_;
  std::uint32_t at_ = 0;                                        // start of the stretch
  std::uint32_t now_ = 0, first_ = 0, above_ = 0, behind_ = 0;  // palette indices
  std::uint32_t above_end_ = 0,
                behind_end_ = 0;  // positions at which above_ and behind_ may change
  std::size_t above_run_ = 0, behind_run_ = 0;
};

void keep_scratch_small(Scratch& s) {
  if (s.runs.capacity() > kScratchRunsKept) std::vector<IndexRun>().swap(s.runs);
  keep_small(s.bytes);
}

}  // namespace

CodedBody code_runs(const RunList& runs, OrderedExtent extent) {
  RUNSTONE_ASSERT(runs.size() > 0);
  Scratch& s = scratch();
  keep_scratch_small(s);
  s.bytes.clear();
  runs.visit([&](const auto& list) {
    s.palette.find(list);
    if (list.size() == 1) return;
    RunCoder coder(RangeEncoder(s.bytes), Known(list, s.palette), s, extent,
                   s.palette.ids().size());
    const auto coded = coder.run();
    RUNSTONE_ASSERT(coded.has_value());
    coder.finish();
  });
  return {s.palette.ids(), s.bytes};
}

Result<RunList> decode_runs(ByteView body, std::span<const Material> palette,
                            OrderedExtent extent) {
  RUNSTONE_ASSERT(palette.size() >= 2);
  Scratch& s = scratch();
  keep_scratch_small(s);
  RunCoder coder(RangeDecoder(body), Unknown{}, s, extent, palette.size());
  if (const auto coded = coder.run(); !coded) return failure(coded.error());
  if (const auto done = coder.finish(); !done) return failure(done.error());
  s.used.assign(palette.size(), 0);
  for (const IndexRun& run : s.runs) s.used[run.index] = 1;
  if (std::find(s.used.begin(), s.used.end(), 0) != s.used.end()) {
    return fail(ErrorCode::not_canonical, "palette names a material that no run has");
  }
  return read_runs(extent.volume(), s.runs.size(), [&](const auto& put) -> Result<void> {
    for (std::size_t i = 0; i < s.runs.size(); ++i) put(i, s.runs[i].end, palette[s.runs[i].index]);
    return {};
  });
}

}  // namespace runstone
