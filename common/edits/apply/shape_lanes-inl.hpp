// The rows of a shape in many lines or layers at once, one to a lane of a vector. They are the same
// rows as those of for_each_row() (ordered_shape.hpp), computed in floating point without rounding
// errors. Highway includes this file once per instruction set, outside of any namespace.
//
// The results are exact: every number is an integer below 2^53, so sums and products are exact as
// doubles.
//   - Roots: for an integer v < 2^52 the rounded square root has the right integer part. Just below
//     a square k^2 the true root is at most k - 1/(2k), and doubles below k <= 2^26 lie closer
//     together than that. For floats, this holds if v < 2^22; spheres need v <= r * r + r <
//     2^18.01.
//   - Quotients: floor(x / a) is computed as floor((x + 1/2) * (1 / a)). This value is at least
//     1/(2a) away from any integer. Two roundings move it by less than |x| / a * 2^-51, which is
//     far less for |x| < 2^33.
//
// Only v = length * e may exceed 2^52 (capsule_row.hpp); fits_doubles() checks it beforehand.
#if defined(RUNSTONE_EDITS_SHAPE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RUNSTONE_EDITS_SHAPE_LANES_INL
#undef RUNSTONE_EDITS_SHAPE_LANES_INL
#else
#define RUNSTONE_EDITS_SHAPE_LANES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "common/edits/apply/layer_plan.hpp"
#include "common/edits/descriptor/capsule_row.hpp"
#include "common/edits/descriptor/ordered_shape.hpp"

HWY_BEFORE_NAMESPACE();
namespace runstone {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The arrays to which results are written: half-open stretches, one for each line or layer of
/// Places, empty where last <= first. Up to one vector more than requested may be written.
struct Ends {
  static constexpr std::size_t kBehind = 8;
  std::uint8_t* first;
  std::uint8_t* last;
};

/// The requested lines or layers, q_first .. q_first + count - 1.
struct Places {
  std::int32_t q_first = 0, count = 0;
};

/// The bounds and the centre of a slice. Results are clipped to low .. high. `centre` counts along
/// the lines, `centre_q` across them.
struct SliceFrame {
  std::int32_t centre = 0, centre_q = 0, low = 0, high = 0;
};

inline bool fits_doubles(const OrderedShape& shape) {
  const auto square = [](std::int32_t d) { return static_cast<double>(d) * d; };
  const double across = square(shape.along[1]) + square(shape.along[2]);
  return (square(shape.along[0]) + across) * across * shape.reach < 0x1p52;
}

/// Rows of a sphere: voxels u with (u - centre)^2 + (q - centre_q)^2 <= reach.
class RoundLanes {
  using D = hn::CappedTag<std::int32_t, Ends::kBehind>;

 public:
  explicit RoundLanes(const SliceFrame& frame) : frame_(frame) {}

  HWY_INLINE void find(std::int32_t reach, const Places& at, const Ends& out) const {
    const D d;
    const hn::Rebind<float, D> floats;
    const hn::Rebind<std::uint8_t, D> bytes;
    const auto low = hn::Set(d, frame_.low), high = hn::Set(d, frame_.high);
    const auto centre = hn::Set(d, frame_.centre);
    for (std::int32_t i = 0; i < at.count; i += static_cast<std::int32_t>(hn::Lanes(d))) {
      const auto q = hn::Iota(d, at.q_first + i - frame_.centre_q);
      const auto rest = hn::Sub(hn::Set(d, reach), hn::Mul(q, q));
      const auto root =
          hn::ConvertTo(d, hn::Sqrt(hn::ConvertTo(floats, hn::Max(rest, hn::Zero(d)))));
      const auto half =
          hn::IfThenElse(hn::Lt(rest, hn::Zero(d)), hn::Set(d, -1), root);  // -1: none
      const auto first = hn::Sub(centre, half),
                 last = hn::Add(hn::Add(centre, half), hn::Set(d, 1));
      hn::StoreU(hn::DemoteTo(bytes, hn::Min(hn::Max(first, low), high)), bytes, out.first + i);
      hn::StoreU(hn::DemoteTo(bytes, hn::Min(hn::Max(last, low), high)), bytes, out.last + i);
    }
  }

 private:
  SliceFrame frame_;
};

/// A slice of a capsule, in the terms of capsule_row.hpp. With offset p = q - centre_q, c = p * dq
/// + c0 and n = p^2 + n0.
struct CapsuleSlice {
  std::int64_t df = 0, across = 0, dq = 0, reach = 0;
};

/// Rows of a capsule, one line after another.
class CapsuleLines {
 public:
  CapsuleLines(const CapsuleSlice& slice, const SliceFrame& frame) : slice_(slice), frame_(frame) {}

  void find(std::int64_t c0, std::int64_t n0, const Places& at, const Ends& out) const {
    const auto clipped = [this](std::int64_t v) {
      return static_cast<std::uint8_t>(
          std::clamp<std::int64_t>(v + frame_.centre, frame_.low, frame_.high));
    };
    for (std::int32_t i = 0; i < at.count; ++i) {
      const std::int64_t p = at.q_first + i - frame_.centre_q;
      const CapsuleRow row =
          capsule_row(slice_.df, slice_.across, p * slice_.dq + c0, p * p + n0, slice_.reach);
      out.first[i] = clipped(row.first);
      out.last[i] = clipped(row.last + 1);
    }
  }

 private:
  CapsuleSlice slice_;
  SliceFrame frame_;
};

#if HWY_HAVE_FLOAT64 && !HWY_HAVE_SCALABLE
/// Rows of a capsule for a vector of lines at a time. Requires fits_doubles().
class CapsuleLanes {
  using D = hn::CappedTag<double, Ends::kBehind>;
  using V = hn::Vec<D>;
  static HWY_INLINE V set(double v) { return hn::Set(D(), v); }
  static HWY_INLINE V whole(std::int64_t v) { return hn::Set(D(), static_cast<double>(v)); }
  static HWY_INLINE V whole_root(V v) { return hn::Floor(hn::Sqrt(hn::Max(v, hn::Zero(D())))); }
  /// Returns floor(x / a), given 1 / a.
  static HWY_INLINE V floor_of(V x, V inverse) {
    return hn::Floor(hn::Mul(hn::Add(x, set(0.5)), inverse));
  }
  static constexpr double kFar = 1 << 20;

 public:
  HWY_INLINE CapsuleLanes(const CapsuleSlice& slice, const SliceFrame& frame)
      : mirrored_(slice.df < 0),
        df_(std::abs(slice.df)),
        across_(slice.across),
        centre_q_(frame.centre_q),
        dq_(whole(slice.dq)),
        reach_(whole(slice.reach)),
        length_(whole(df_ * df_ + across_)),
        by_across_(set(across_ == 0 ? 0.0 : 1.0 / static_cast<double>(across_))),
        by_df_(set(df_ == 0 ? 0.0 : 1.0 / static_cast<double>(df_))),
        centre_(whole(frame.centre)),
        low_(whole(frame.low)),
        high_(whole(frame.high)) {}

  HWY_INLINE void find(std::int64_t c0, std::int64_t n0, const Places& at, const Ends& out) const {
    const hn::Rebind<std::int32_t, D> ints;
    const hn::Rebind<std::uint8_t, D> bytes;
    const V v_c0 = whole(c0), v_n0 = whole(n0);
    for (std::int32_t i = 0; i < at.count; i += static_cast<std::int32_t>(hn::Lanes(D()))) {
      V first, last;
      row(hn::Iota(D(), static_cast<double>(at.q_first + i - centre_q_)), v_c0, v_n0, first, last);
      if (mirrored_) {
        const V turned = hn::Neg(last);
        last = hn::Neg(first);
        first = turned;
      }
      const V from = hn::Min(hn::Max(hn::Add(centre_, first), low_), high_);
      const V to = hn::Min(hn::Max(hn::Add(hn::Add(centre_, last), set(1.0)), low_), high_);
      hn::StoreU(hn::DemoteTo(bytes, hn::DemoteTo(ints, from)), bytes, out.first + i);
      hn::StoreU(hn::DemoteTo(bytes, hn::DemoteTo(ints, to)), bytes, out.last + i);
    }
  }

 private:
  /// Does the steps of capsule_row() without its early returns, which do not change the result.
  HWY_INLINE void row(V p, V c0, V n0, V& first, V& last) const {
    const V zero = hn::Zero(D()), df = whole(df_), across = whole(across_);
    const V c = hn::Add(hn::Mul(p, dq_), c0);
    const V start_left = hn::Sub(reach_, hn::Add(hn::Mul(p, p), n0));
    const V start_half = whole_root(start_left);
    if (across_ == 0) {  // the lines run along the segment
      const auto none = hn::Lt(start_left, zero);
      first = hn::IfThenElse(none, set(kFar), hn::Neg(start_half));
      last = hn::IfThenElse(none, set(-kFar), hn::Add(df, start_half));
      return;
    }
    const V e = hn::Add(hn::Mul(c, c), hn::Mul(across, start_left));
    const V root = whole_root(hn::Mul(length_, e));
    const V middle = hn::Mul(df, c);
    V body_first = hn::Neg(floor_of(hn::Sub(root, middle), by_across_));
    V body_last = floor_of(hn::Add(root, middle), by_across_);
    const auto meets = hn::And(hn::Ge(e, zero), hn::Le(body_first, body_last));
    auto has_body = meets;
    if (df_ == 0) {
      has_body = hn::And(meets, hn::And(hn::Ge(c, zero), hn::Le(c, length_)));
    } else {
      body_first = hn::Max(body_first, hn::Neg(floor_of(c, by_df_)));
      body_last = hn::Min(body_last, floor_of(hn::Sub(length_, c), by_df_));
      has_body = hn::And(meets, hn::Le(body_first, body_last));
    }
    first = hn::IfThenElse(has_body, body_first, set(kFar));
    last = hn::IfThenElse(has_body, body_last, set(-kFar));
    const auto at_start = hn::And(meets, hn::Ge(start_left, zero));
    first = hn::IfThenElse(at_start, hn::Min(first, hn::Neg(start_half)), first);
    last = hn::IfThenElse(at_start, hn::Max(last, start_half), last);
    const V end_left = hn::Sub(hn::Add(start_left, hn::Add(c, c)), across);
    const V end_half = whole_root(end_left);
    const auto at_end = hn::And(meets, hn::Ge(end_left, zero));
    first = hn::IfThenElse(at_end, hn::Min(first, hn::Sub(df, end_half)), first);
    last = hn::IfThenElse(at_end, hn::Max(last, hn::Add(df, end_half)), last);
  }

  bool mirrored_;
  std::int64_t df_, across_;
  std::int32_t centre_q_;
  V dq_, reach_, length_, by_across_, by_df_, centre_, low_, high_;
};
#else
using CapsuleLanes = CapsuleLines;
#endif

/// The lines that a shape meets in each layer of a band.
class LayerLines {
 public:
  Ends ends() { return {first_.data(), last_.data()}; }
  template <class F>
  HWY_INLINE void for_each(std::uint32_t s_first, std::uint32_t s_last, F&& f) const {
    for (std::uint32_t s = s_first; s < s_last; ++s) {
      const std::size_t i = s - s_first;
      if (first_[i] < last_[i]) f(s, first_[i], last_[i]);
    }
  }

 private:
  std::array<std::uint8_t, LayerPlan::kBand + Ends::kBehind> first_, last_;
};

template <class F>
HWY_INLINE void find_round_rows(const OrderedShape& shape, std::uint32_t s_first,
                                std::uint32_t s_last, F&& room) {
  const auto bound = [](std::uint32_t v) { return static_cast<std::int32_t>(v); };
  LayerLines lines;
  RoundLanes({shape.centre[1], shape.centre[2], bound(shape.first[1]), bound(shape.last[1])})
      .find(shape.reach, {bound(s_first), bound(s_last - s_first)}, lines.ends());
  const RoundLanes rows(
      {shape.centre[0], shape.centre[1], bound(shape.first[0]), bound(shape.last[0])});
  lines.for_each(s_first, s_last, [&](std::uint32_t s, std::uint8_t m_first, std::uint8_t m_last) {
    const std::int32_t p = bound(s) - shape.centre[2];
    rows.find(shape.reach - p * p, {m_first, m_last - m_first}, room(s, m_first, m_last));
  });
}

template <class Lanes, class F>
HWY_INLINE void find_capsule_rows(const OrderedShape& shape, std::uint32_t s_first,
                                  std::uint32_t s_last, F&& room) {
  const auto bound = [](std::uint32_t v) { return static_cast<std::int32_t>(v); };
  const std::int64_t df = shape.along[0], dm = shape.along[1], ds = shape.along[2];
  LayerLines lines;
  // The lines that the capsule meets are the row of its projection onto the plane across them.
  Lanes({dm, ds * ds, ds, shape.reach},
        {shape.centre[1], shape.centre[2], bound(shape.first[1]), bound(shape.last[1])})
      .find(0, 0, {bound(s_first), bound(s_last - s_first)}, lines.ends());
  const Lanes rows({df, dm * dm + ds * ds, dm, shape.reach},
                   {shape.centre[0], shape.centre[1], bound(shape.first[0]), bound(shape.last[0])});
  lines.for_each(s_first, s_last, [&](std::uint32_t s, std::uint8_t m_first, std::uint8_t m_last) {
    const std::int64_t p = bound(s) - shape.centre[2];
    rows.find(p * ds, p * p, {m_first, m_last - m_first}, room(s, m_first, m_last));
  });
}

/// Finds the rows of a shape in layers [s_first, s_last). Requires a shape that is no box, and at
/// most a band of layers. For every layer that has lines, room(s, m_first, m_last) returns the
/// place to write their rows.
template <class F>
void find_rows(const OrderedShape& shape, std::uint32_t s_first, std::uint32_t s_last, F&& room) {
  if (shape.form == OrderedShape::Form::sphere) {
    find_round_rows(shape, s_first, s_last, room);
  } else if (fits_doubles(shape)) {
    find_capsule_rows<CapsuleLanes>(shape, s_first, s_last, room);
  } else {
    find_capsule_rows<CapsuleLines>(shape, s_first, s_last, room);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace runstone
HWY_AFTER_NAMESPACE();

#endif
