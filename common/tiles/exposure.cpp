#include "common/tiles/exposure.hpp"

namespace runstone::tiles {
namespace {

/// One word of every second line of a layer, with all that can hide its faces. Each pointer is a
/// list with an entry for each line. A face is hidden if the voxel beyond is opaque or of the same
/// transparent material.
struct WordOfLines {
  const Row64* solid;
  const Row64 *opaque, *opaque_below, *opaque_above;  // the word, the one before it, the next one
  const Row64 *same, *same_below;                     // along the line
  const Row64 *opaque_low, *same_low;                 // the line before
  const Row64 *opaque_high, *same_high;               // the next line
  const Row64 *opaque_before, *same_before;           // the layer before
  const Row64 *opaque_behind, *same_behind;           // the next layer
  Row64 first, last;                                  // the bits of the ends of the lines
};

/// Counts the drawn faces of `lines` words. Entries of the results: see ExposureSweep::counts_.
template <bool kSeveralWords>
void count_faces(const WordOfLines& in, std::size_t lines, Row64* __restrict ones,
                 Row64* __restrict twos, Row64* __restrict fours) {
  const WordOfLines rows = in;  // a copy that the results cannot alias
  for (std::size_t i = 0; i < lines; ++i) {
    const Row64 opaque = rows.opaque[i], same = rows.same[i], solid = rows.solid[i];
    Row64 along_low = opaque << 1 | same << 1 | rows.first;
    Row64 along_high = opaque >> 1 | same | rows.last;
    if constexpr (kSeveralWords) {
      along_low |= (rows.opaque_below[i] | rows.same_below[i]) >> 63;
      along_high |= rows.opaque_above[i] << 63;
    }
    const Row64 a = solid & ~along_low;
    const Row64 b = solid & ~along_high;
    const Row64 c = solid & ~(rows.opaque_low[i] | rows.same_low[i]);
    const Row64 d = solid & ~(rows.opaque_high[i] | rows.same_high[i]);
    const Row64 e = solid & ~(rows.opaque_before[i] | rows.same_before[i]);
    const Row64 f = solid & ~(rows.opaque_behind[i] | rows.same_behind[i]);
    const Row64 abc = a ^ b ^ c, abc_carry = (a & b) | (c & (a ^ b));
    const Row64 def = d ^ e ^ f, def_carry = (d & e) | (f & (d ^ e));
    const Row64 carry = abc & def;
    ones[i] = abc ^ def;
    twos[i] = abc_carry ^ def_carry ^ carry;
    fours[i] = (abc_carry & def_carry) | (carry & (abc_carry ^ def_carry));
  }
}

/// 64 voxels, one of each of 64 cells: their counts and their coordinates in the cell.
struct Candidates {
  Row64 ones, twos, fours;
  Row64 f, m, s;
};

/// Returns, for each cell, the more exposed of two voxels; `a` if they are equal.
inline Candidates more_exposed(const Candidates& a, const Candidates& b) {
  const Row64 equal_fours = ~(a.fours ^ b.fours), equal_twos = ~(a.twos ^ b.twos);
  const Row64 take_b =
      (b.fours & ~a.fours) | (equal_fours & ((b.twos & ~a.twos) | (equal_twos & b.ones & ~a.ones)));
  const auto pick = [take_b](Row64 from_a, Row64 from_b) {
    return from_a ^ ((from_a ^ from_b) & take_b);
  };
  return {pick(a.ones, b.ones), pick(a.twos, b.twos), pick(a.fours, b.fours),
          pick(a.f, b.f),       pick(a.m, b.m),       pick(a.s, b.s)};
}

using CountRows = std::array<std::array<const Row64*, 3>, 4>;  // by m + 2 * s and weight

/// Returns the voxels at one place in their cells, from entry i of the counts.
template <AxisOrder kOrder, unsigned kX, unsigned kY, unsigned kZ>
Candidates candidates(const CountRows& counts, std::size_t i) {
  constexpr OrderedPos kAt = to_ordered({kX, kY, kZ}, kOrder);
  const auto& line = counts[kAt.m + 2 * kAt.s];
  constexpr auto kAll = [](std::uint32_t bit) { return bit != 0 ? ~Row64{0} : Row64{0}; };
  return {line[0][i] >> kAt.f, line[1][i] >> kAt.f, line[2][i] >> kAt.f,
          kAll(kAt.f),         kAll(kAt.m),         kAll(kAt.s)};
}

/// Compares the eight voxels of each cell. The first voxel of a comparison wins a tie, so the order
/// of the comparisons is the order of the rule: z decides last, y first.
template <AxisOrder kOrder>
void choose(const CountRows& counts, std::size_t size, Row64* __restrict out_f,
            Row64* __restrict out_m, Row64* __restrict out_s) {
  const CountRows rows = counts;
  for (std::size_t i = 0; i < size; ++i) {
    const Candidates upper = more_exposed(
        more_exposed(candidates<kOrder, 0, 1, 0>(rows, i), candidates<kOrder, 0, 1, 1>(rows, i)),
        more_exposed(candidates<kOrder, 1, 1, 0>(rows, i), candidates<kOrder, 1, 1, 1>(rows, i)));
    const Candidates lower = more_exposed(
        more_exposed(candidates<kOrder, 0, 0, 0>(rows, i), candidates<kOrder, 0, 0, 1>(rows, i)),
        more_exposed(candidates<kOrder, 1, 0, 0>(rows, i), candidates<kOrder, 1, 0, 1>(rows, i)));
    const Candidates top = more_exposed(upper, lower);
    out_f[i] = top.f;
    out_m[i] = top.m;
    out_s[i] = top.s;
  }
}

}  // namespace

void ExposureSweep::reset(unsigned edge) {
  edge_ = edge;
  words_ = (2 * edge_ + 63) / 64;
  for (auto& line : counts_) {
    for (auto& weight : line) weight.resize(edge_ * words_);
  }
}

void ExposureSweep::find(const LayerWindow& window, AxisOrder order, MostExposed& out) {
  const std::array<const LayerRows*, 4> layers = {window.before, window.middle[0], window.middle[1],
                                                  window.behind};
  for (std::size_t w = 0; w < words_; ++w) {
    for (std::size_t s = 0; s < 2; ++s) {
      const LayerRows& layer = *layers[s + 1];
      const LayerRows& before = *layers[s];
      const LayerRows& behind = *layers[s + 2];
      // Words outside of the line are not there; any word with the right count of lines does.
      const std::size_t below = w == 0 ? w : w - 1, above = w + 1 == words_ ? w : w + 1;
      WordOfLines even{}, odd{};
      even.first = odd.first = w == 0 ? 1 : 0;
      even.last = odd.last = w + 1 == words_ ? Row64{1} << ((2 * edge_ - 1) % 64) : 0;
      even.solid = layer.solid.even(w);
      even.opaque = layer.opaque.even(w);
      even.opaque_below = layer.opaque.even(below);
      even.opaque_above = layer.opaque.even(above);
      even.same = layer.same_along.even(w);
      even.same_below = layer.same_along.even(below);
      even.opaque_low = layer.opaque.before_even(w);
      even.same_low = layer.same_across.before_even(w);
      even.opaque_high = layer.opaque.odd(w);
      even.same_high = layer.same_across.even(w);
      even.opaque_before = before.opaque.even(w);
      even.same_before = layer.same_before.even(w);
      even.opaque_behind = behind.opaque.even(w);
      even.same_behind = behind.same_before.even(w);
      odd.solid = layer.solid.odd(w);
      odd.opaque = layer.opaque.odd(w);
      odd.opaque_below = layer.opaque.odd(below);
      odd.opaque_above = layer.opaque.odd(above);
      odd.same = layer.same_along.odd(w);
      odd.same_below = layer.same_along.odd(below);
      odd.opaque_low = layer.opaque.even(w);
      odd.same_low = layer.same_across.even(w);
      odd.opaque_high = layer.opaque.even(w) + 1;
      odd.same_high = layer.same_across.odd(w);
      odd.opaque_before = before.opaque.odd(w);
      odd.same_before = layer.same_before.odd(w);
      odd.opaque_behind = behind.opaque.odd(w);
      odd.same_behind = behind.same_before.odd(w);
      const auto count = words_ == 1 ? count_faces<false> : count_faces<true>;
      for (const bool is_odd : {false, true}) {
        auto& to = counts_[(is_odd ? 1 : 0) + 2 * s];
        count(is_odd ? odd : even, edge_, to[0].data() + w * edge_, to[1].data() + w * edge_,
              to[2].data() + w * edge_);
      }
    }
  }
  CountRows rows{};
  for (std::size_t line = 0; line < rows.size(); ++line) {
    for (std::size_t weight = 0; weight < 3; ++weight)
      rows[line][weight] = counts_[line][weight].data();
  }
  const std::size_t size = edge_ * words_;
  for (auto* list : {&out.f, &out.m, &out.s}) list->resize(size);
  using Choose = void (*)(const CountRows&, std::size_t, Row64*, Row64*, Row64*);
  static constexpr std::array<Choose, kAxisOrderCount> kChoose = {
      choose<AxisOrder::xyz>, choose<AxisOrder::xzy>, choose<AxisOrder::yxz>,
      choose<AxisOrder::yzx>, choose<AxisOrder::zxy>, choose<AxisOrder::zyx>};
  kChoose[static_cast<std::size_t>(order)](rows, size, out.f.data(), out.m.data(), out.s.data());
}

}  // namespace runstone::tiles
