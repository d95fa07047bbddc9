#include "common/mesh/occlusion/quad_occlusion.hpp"

#include <algorithm>
#include <cstddef>

namespace runstone {
namespace {

using Level = std::uint8_t;

/// Returns the occlusion of a point from the three voxels before the face there: the two beside the
/// point, and the diagonal one.
constexpr Level point_level(unsigned beside_u, unsigned beside_v, unsigned diagonal) {
  return static_cast<Level>(beside_u + beside_v == 2 ? 3U : beside_u + beside_v + diagonal);
}

/// Cuts quads of one direction.
class QuadCutter {
 public:
  QuadCutter(const OpaqueBits& bits, Direction direction, OccludedQuads& out)
      : bits_(bits),
        direction_(direction),
        u_step_(bits.step(u_axis_of(axis_of(direction)))),
        v_step_(bits.step(v_axis_of(axis_of(direction)))),
        layer_step_(bits.step(axis_of(direction))),
        u_shift_(shift_of(u_axis_of(axis_of(direction)))),
        v_shift_(shift_of(v_axis_of(axis_of(direction)))),
        out_(out) {}

  void cut(Quad quad) {
    const QuadFields q = unpack(quad);
    width_ = q.width;
    height_ = q.height;
    base_ = quad.bits & ~(std::uint64_t{0x3fff} << 21);
    if (width_ == 1 && height_ == 1) return put_face(q);
    if (!read_rim(q)) {
      put(0, 0, width_, height_, 0, 0, 0, 0);
      return;
    }
    // A row or a column of faces is cut along its length. A larger quad loses the rows and columns
    // at those sides that are dark somewhere. The part that is left has no dark point.
    if (height_ == 1) {
      cut_row(0, lower_.data(), upper_.data());
      return;
    }
    if (width_ == 1) {
      cut_column(0, 0, height_, left_.data(), right_.data());
      return;
    }
    const bool cuts_lower = is_dark(lower_.data() + 1, width_ - 1);
    const bool cuts_upper = is_dark(upper_.data() + 1, width_ - 1);
    const unsigned first = cuts_lower ? 1 : 0, last = height_ - (cuts_upper ? 1 : 0);
    if (cuts_lower) {
      inner_[0] = left_[1];
      inner_[width_] = right_[1];
      cut_row(0, lower_.data(), inner_.data());
      inner_[0] = inner_[width_] = 0;
    }
    if (first < last) cut_middle(first, last);
    if (cuts_upper) {
      inner_[0] = left_[height_ - 1];
      inner_[width_] = right_[height_ - 1];
      cut_row(height_ - 1, inner_.data(), upper_.data());
      inner_[0] = inner_[width_] = 0;
    }
  }

 private:
  /// Points along a side of a quad.
  using Points = std::array<Level, kSideMax + 1>;

  static unsigned shift_of(Axis axis) { return 7 * static_cast<unsigned>(axis); }
  static bool is_dark(const Level* points, unsigned count) {
    return std::any_of(points, points + count, [](Level level) { return level != 0; });
  }

  /// Returns the bit of the voxel before the face at the lowest corner.
  std::uint32_t place_before(const QuadFields& q) const {
    return bits_.place(q.x, q.y, q.z) + (is_positive(direction_) ? layer_step_ : 0U - layer_step_);
  }

  /// Adds a quad of a single face. Most quads have one face.
  void put_face(const QuadFields& q) {
    const std::uint32_t at = place_before(q), below = at - v_step_, above = at + v_step_;
    const unsigned left = bits_.at(at - u_step_), right = bits_.at(at + u_step_);
    const unsigned lower = bits_.at(below), upper = bits_.at(above);
    put(0, 0, 1, 1, point_level(left, lower, bits_.at(below - u_step_)),
        point_level(right, lower, bits_.at(below + u_step_)),
        point_level(left, upper, bits_.at(above - u_step_)),
        point_level(right, upper, bits_.at(above + u_step_)));
  }

  /// Reads the points of the four sides. Returns false if none is dark.
  bool read_rim(const QuadFields& q) {
    const std::uint32_t low = place_before(q);
    // The voxels around those before the quad: a side and its corners.
    const std::uint32_t high = low + (width_ - 1) * u_step_ + (height_ - 1) * v_step_;
    const unsigned c00 = bits_.at(low - u_step_ - v_step_);
    const unsigned c10 = bits_.at(low + width_ * u_step_ - v_step_);
    const unsigned c01 = bits_.at(low - u_step_ + height_ * v_step_);
    const unsigned c11 = bits_.at(high + u_step_ + v_step_);
    unsigned any = c00 | c10 | c01 | c11;
    unsigned lower = 0, upper = 0, left = 0, right = 0;
    for (unsigned i = 0; i < width_; ++i) {
      any |= below_[i] = bits_.at(low + i * u_step_ - v_step_);
      any |= above_[i] = bits_.at(low + i * u_step_ + height_ * v_step_);
    }
    for (unsigned i = 0; i < height_; ++i) {
      any |= before_[i] = bits_.at(low + i * v_step_ - u_step_);
      any |= behind_[i] = bits_.at(low + i * v_step_ + width_ * u_step_);
    }
    if (any == 0) return false;
    lower = below_[0], upper = above_[0], left = before_[0], right = behind_[0];
    for (unsigned i = 1; i < width_; ++i) {
      lower_[i] = static_cast<Level>(below_[i - 1] + below_[i]);
      upper_[i] = static_cast<Level>(above_[i - 1] + above_[i]);
    }
    for (unsigned i = 1; i < height_; ++i) {
      left_[i] = static_cast<Level>(before_[i - 1] + before_[i]);
      right_[i] = static_cast<Level>(behind_[i - 1] + behind_[i]);
    }
    lower_[0] = left_[0] = point_level(left, lower, c00);
    lower_[width_] = right_[0] = point_level(right, below_[width_ - 1], c10);
    upper_[0] = left_[height_] = point_level(before_[height_ - 1], upper, c01);
    upper_[width_] = right_[height_] = point_level(behind_[height_ - 1], above_[width_ - 1], c11);
    return true;
  }

  /// Cuts rows [first, last), whose points are dark at u = 0 and at u = width only.
  void cut_middle(unsigned first, unsigned last) {
    const bool cuts_left = is_dark(left_.data() + first, last - first + 1);
    const bool cuts_right = is_dark(right_.data() + first, last - first + 1);
    const unsigned begin = cuts_left ? 1 : 0, end = width_ - (cuts_right ? 1 : 0);
    if (cuts_left) cut_column(0, first, last, left_.data(), none_.data());
    if (begin < end) put(begin, first, end - begin, last - first, 0, 0, 0, 0);
    if (cuts_right) cut_column(width_ - 1, first, last, none_.data(), right_.data());
  }

  /// Cuts a row of faces, whose points are `lower` and `upper`, at each face that differs from the
  /// one before it or whose points differ along the row.
  void cut_row(unsigned v, const Level* lower, const Level* upper) {
    for (unsigned first = 0; first < width_;) {
      unsigned last = first + 1;
      if (lower[first] == lower[last] && upper[first] == upper[last]) {
        while (last < width_ && lower[last + 1] == lower[first] && upper[last + 1] == upper[first])
          ++last;
      }
      put(first, v, last - first, 1, lower[first], lower[last], upper[first], upper[last]);
      first = last;
    }
  }
  /// Cuts the faces [first, end) of a column.
  void cut_column(unsigned u, unsigned first, unsigned end, const Level* left, const Level* right) {
    while (first < end) {
      unsigned last = first + 1;
      if (left[first] == left[last] && right[first] == right[last]) {
        while (last < end && left[last + 1] == left[first] && right[last + 1] == right[first])
          ++last;
      }
      put(u, first, 1, last - first, left[first], right[first], left[last], right[last]);
      first = last;
    }
  }

  /// Adds a part of the quad with the occlusion of its corners: at the lowest u and v, at the
  /// highest u, at the highest v, and at both.
  void put(unsigned u, unsigned v, unsigned width, unsigned height, unsigned low, unsigned at_u,
           unsigned at_v, unsigned high) {
    out_.quads.quads.push_back(
        {base_ + (std::uint64_t{u} << u_shift_) + (std::uint64_t{v} << v_shift_) +
         (std::uint64_t{width - 1} << 21 | std::uint64_t{height - 1} << 28)});
    if (!is_positive(direction_)) std::swap(at_u, at_v);  // as quad_corners() winds
    out_.corners.push_back(static_cast<CornerOcclusion>(low | at_u << 2 | high << 4 | at_v << 6));
  }

  const OpaqueBits& bits_;
  const Direction direction_;
  const std::uint32_t u_step_, v_step_, layer_step_;
  const unsigned u_shift_, v_shift_;
  OccludedQuads& out_;
  std::uint64_t base_ = 0;  // the quad without its sizes
  unsigned width_ = 0, height_ = 0;
  // By face along a side: 1 if the voxel beyond is opaque.
  std::array<unsigned, kSideMax> below_, above_, before_, behind_;
  Points lower_, upper_, left_, right_;
  Points inner_{};  // dark at its ends only while a row is cut
  Points none_{};
};

}  // namespace

void occlude_quads(const QuadLayers& quads, const OpaqueBits& bits, OccludedQuads& out) {
  out.clear();
  if (quads.quads.empty()) return;
  out.quads.quads.reserve(2 * quads.quads.size());
  out.corners.reserve(2 * quads.quads.size());
  std::uint32_t next = 0;
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    QuadCutter cutter(bits, static_cast<Direction>(d), out);
    for (std::size_t layer = d * kSideMax; layer < (d + 1) * kSideMax; ++layer) {
      out.quads.first[layer] = static_cast<std::uint32_t>(out.quads.quads.size());
      for (const std::uint32_t end = quads.first[layer + 1]; next < end; ++next)
        cutter.cut(quads.quads[next]);
    }
  }
  out.quads.first.back() = static_cast<std::uint32_t>(out.quads.quads.size());
}

}  // namespace runstone
