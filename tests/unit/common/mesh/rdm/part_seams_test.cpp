#include "common/mesh/rdm/part_seams.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <memory>
#include <tuple>
#include <utility>

namespace runstone::rdm {
namespace {

constexpr Material kSeamStone = 1, kSeamDirt = 2;
/// In an open quad that no test opened.
constexpr Quad kUntouched = {0x1234};

using LayerQuads = std::vector<std::pair<std::pair<Direction, unsigned>, std::vector<Quad>>>;

/// Returns the quads of some layers, which are in ascending order.
QuadLayers seam_layers(const LayerQuads& all) {
  QuadLayers out;
  auto next = all.begin();
  for (std::size_t i = 0; i < kDirectionCount * kSideMax; ++i) {
    out.first.at(i) = static_cast<std::uint32_t>(out.quads.size());
    if (next == all.end()) continue;
    const auto& [at, quads] = *next;
    if (static_cast<std::size_t>(at.first) * kSideMax + at.second != i) continue;
    out.quads.insert(out.quads.end(), quads.begin(), quads.end());
    ++next;
  }
  out.first.back() = static_cast<std::uint32_t>(out.quads.size());
  return out;
}

/// The seams of a part of a chunk in the order xyz: z is the slow, y the middle and x the fast axis.
/// The open quads are kUntouched, and the strips of the fast sides begin in layer 99.
template <class Row>
struct SeamCase {
  SeamCase(Extent extent, const SweepPart<Row>& of, QuadLayers before, std::uint64_t mark = 0)
      : chunk(uniform_chunk(extent, kSeamStone, AxisOrder::xyz)),
        part(of),
        layers(std::move(before)),
        seams(chunk, part, layers, buckets, mark, *state, list) {
    for (auto& open : state->open) open.fill(kUntouched);
    for (auto& start : state->start_layer) start.fill(99);
  }
  // The seams refer to the other members.
  SeamCase(const SeamCase&) = delete;
  SeamCase& operator=(const SeamCase&) = delete;

  RunChunk chunk;
  SweepPart<Row> part;
  QuadLayers layers;
  QuadBuckets buckets;
  std::unique_ptr<SweepState<Row>> state = std::make_unique<SweepState<Row>>();
  std::vector<PartSeam> list;
  PartSeams<Row> seams;

  void put(Direction d, unsigned layer, Quad quad) { QuadBuckets::put(buckets.of(d)[layer], quad); }
  /// Closes the seams and returns the layers with their new quads.
  QuadLayers closed() {
    QuadSplice splice;
    seams.close(splice);
    QuadLayers out = layers;
    splice.apply(out);
    return out;
  }
  Quad& open_quad(Side side, unsigned layer, unsigned end) {
    return state->open.at(at(side)).at(layer * kRowBits<Row> + end);
  }
  std::uint8_t& start(Side side, unsigned layer, unsigned row) {
    return state->start_layer.at(at(side) - at(Side::fast_neg)).at(row * kRowBits<Row> + layer);
  }
};

std::uint8_t byte(unsigned value) { return static_cast<std::uint8_t>(value); }

/// Returns the quad of faces towards +y in layer y = 3: faces [x, x + length) in rows
/// [begin, end) along z.
Quad side_quad(unsigned x, unsigned length, unsigned begin, unsigned end,
               Material material = kSeamStone) {
  return pack(
      {byte(x), 3, byte(begin), byte(end - begin), byte(length), Direction::pos_y, material});
}
constexpr QuadShape kSideShape(Direction::pos_y, Axis::x, Axis::z);

/// Returns the quad of faces towards +x in layer x = 2: strips [begin, end) along z, in rows
/// [y, y + rows).
Quad fast_quad(unsigned y, unsigned rows, unsigned begin, unsigned end,
               Material material = kSeamStone) {
  return pack({2, byte(y), byte(begin), byte(rows), byte(end - begin), Direction::pos_x, material});
}

/// Returns the part of layers 3 and 4 that traces layer `layer` of one side.
SweepPart<Row32> part_of(Side side, unsigned layer) {
  SweepPart<Row32> part{3, 5, {}};
  part.traced[at(side)] = 1u << layer;
  return part;
}

/// A chunk of edge 8 with quads towards +y in layer y = 3. The part is layers 3 and 4.
struct SideCase : SeamCase<Row32> {
  explicit SideCase(std::vector<Quad> quads, std::uint64_t mark = 0)
      : SeamCase(Extent::cube(8), part_of(Side::mid_pos, 3),
                 seam_layers({{{Direction::pos_y, 3}, std::move(quads)}}), mark) {}
};

/// A chunk of edge 8 with quads towards +x in layer x = 2. The part is layers 3 and 4.
struct FastCase : SeamCase<Row32> {
  explicit FastCase(std::vector<Quad> quads)
      : SeamCase(Extent::cube(8), part_of(Side::fast_pos, 2),
                 seam_layers({{{Direction::pos_x, 2}, std::move(quads)}})) {}
};

/// Returns the seams of one direction as layer, begin and behind.
std::vector<std::tuple<unsigned, unsigned, unsigned>> seams_of(const std::vector<PartSeam>& seams,
                                                               Direction d) {
  std::vector<std::tuple<unsigned, unsigned, unsigned>> found;
  for (const PartSeam& seam : seams) {
    if (seam.direction == d) found.emplace_back(seam.layer, seam.begin, seam.behind);
  }
  return found;
}

TEST_CASE("a part without layers to trace opens nothing, and its seams keep all quads", "[mesh]") {
  const std::vector<Quad> quads = {side_quad(0, 1, 0, 2), side_quad(0, 1, 3, 5)};
  SideCase made(quads);
  made.part.traced = {};
  made.seams.open();
  CHECK(seams_of(made.list, Direction::pos_y).empty());
  CHECK(made.closed().quads == quads);
}

TEST_CASE("quads of a middle side are kept, replaced or opened by where they end and begin",
          "[mesh]") {
  for (const std::uint64_t mark : {std::uint64_t{0}, kTransparentQuad}) {
    const std::vector<Quad> quads = {
        side_quad(0, 1, 0, 2),  // ends before the part: kept
        side_quad(1, 1, 0, 3),  // ends where the part begins: opened
        side_quad(2, 2, 1, 4),  // ends in the part: opened
        side_quad(4, 1, 3, 5),  // begins in the part: the sweep opens it
        side_quad(5, 1, 0, 6),  // crosses the part: opened, and keeps its end
        side_quad(6, 1, 5, 8),  // begins where the part ends: the sweep opens it
        side_quad(7, 1, 6, 8),  // begins behind the part: kept
    };
    SideCase made(quads, mark);
    made.seams.open();
    REQUIRE(seams_of(made.list, Direction::pos_y) == std::vector{std::tuple{3u, 1u, 4u}});
    for (unsigned end = 0; end < 8; ++end) {
      CAPTURE(end);
      const Quad open = made.open_quad(Side::mid_pos, 3, end);
      if (end == 1 || end == 3 || end == 5) {
        const Quad quad = quads.at(end == 1 ? 1 : end == 3 ? 2 : 4);
        CHECK(kSideShape.close(open, kSideShape.row_end(quad)).bits == (quad.bits ^ mark));
      } else {
        CHECK(open == kUntouched);
      }
    }

    // The sweep finds one quad in the part. The strip that crosses the part was cut in row 3, and
    // the strip behind it begins one row earlier.
    made.put(Direction::pos_y, 3, side_quad(1, 1, 0, 4));
    made.open_quad(Side::mid_pos, 3, 5).bits =
        kSideShape.open({3, 5, 1, 4}, kSeamStone).bits ^ mark;
    made.open_quad(Side::mid_pos, 3, 6).bits =
        kSideShape.open({3, 6, 1, 4}, kSeamStone).bits ^ mark;
    CHECK(made.closed().quads == std::vector{quads[0], side_quad(1, 1, 0, 4), side_quad(5, 1, 4, 6),
                                             side_quad(6, 1, 4, 8), quads[6]});
    CHECK(made.buckets.of(Direction::pos_y)[3].count == 0);  // as the next part expects it
  }
}

TEST_CASE("two quads of a middle side that the part joins are one", "[mesh]") {
  // There was a gap in row 4. It is filled, so the strip that was opened continues to the end.
  SideCase made({side_quad(2, 3, 0, 4), side_quad(2, 3, 5, 8)});
  made.seams.open();
  REQUIRE(seams_of(made.list, Direction::pos_y) == std::vector{std::tuple{3u, 0u, 1u}});
  CHECK(made.closed().quads == std::vector{side_quad(2, 3, 0, 8)});
}

TEST_CASE("quads of a fast side are kept, replaced or opened by where they end and begin",
          "[mesh]") {
  const std::vector<Quad> quads = {
      fast_quad(0, 1, 0, 2),  // ends before the part: kept
      fast_quad(1, 1, 0, 3),  // ends where the part begins: opened
      fast_quad(2, 1, 3, 5),  // begins in the part: the sweep opens it
      fast_quad(3, 2, 1, 6),  // crosses the part: opened, and keeps its end
      fast_quad(5, 1, 5, 8),  // begins where the part ends: the sweep opens it
      fast_quad(6, 2, 6, 8),  // begins behind the part: kept
  };
  FastCase made(quads);
  made.seams.open();
  REQUIRE(seams_of(made.list, Direction::pos_x) == std::vector{std::tuple{2u, 1u, 3u}});
  const std::array<unsigned, 8> expected = {99, 0, 99, 1, 1, 99, 99, 99};
  for (unsigned row = 0; row < 8; ++row) {
    CAPTURE(row);
    CHECK(made.start(Side::fast_pos, 2, row) == expected.at(row));
  }
  made.start(Side::fast_pos, 2, 5) = 5;  // as the sweep leaves it
  CHECK(made.closed().quads == std::vector{quads[0], quads[3], quads[4], quads[5]});
}

TEST_CASE("a quad of a fast side is cut where one of its strips begins elsewhere now", "[mesh]") {
  FastCase made({fast_quad(1, 3, 1, 8)});
  made.seams.open();
  made.start(Side::fast_pos, 2, 2) = 4;
  CHECK(made.closed().quads ==
        std::vector{fast_quad(1, 1, 1, 8), fast_quad(2, 1, 4, 8), fast_quad(3, 1, 1, 8)});
}

TEST_CASE("quads of a fast side join if their strips begin together now", "[mesh]") {
  FastCase made({fast_quad(0, 1, 1, 8), fast_quad(1, 2, 5, 8), fast_quad(3, 1, 5, 8, kSeamDirt),
                 fast_quad(5, 1, 1, 8), fast_quad(6, 1, 6, 8), fast_quad(7, 1, 1, 8)});
  made.seams.open();
  for (const unsigned row : {1u, 2u, 3u}) made.start(Side::fast_pos, 2, row) = 1;
  // Another material, a row between them, or a quad behind the part keeps quads apart.
  CHECK(made.closed().quads == std::vector{fast_quad(0, 3, 1, 8), fast_quad(3, 1, 1, 8, kSeamDirt),
                                           fast_quad(5, 1, 1, 8), fast_quad(6, 1, 6, 8),
                                           fast_quad(7, 1, 1, 8)});
}

TEST_CASE("the slow sides of a part are replaced in its layers and beside them", "[mesh]") {
  // One quad in each layer towards -z, and two in each layer towards +z.
  LayerQuads all;
  for (const Direction d : {Direction::neg_z, Direction::pos_z}) {
    for (unsigned z = 0; z < 8; ++z) {
      const Quad quad = pack({0, 0, byte(z), 1, 1, d, kSeamStone});
      all.push_back({{d, z}, std::vector<Quad>(d == Direction::neg_z ? 1 : 2, quad)});
    }
  }
  const auto check = [&](SweepPart<Row32> part, unsigned neg_begin, unsigned neg_end,
                         unsigned pos_begin, unsigned pos_end) {
    CAPTURE(part.begin, part.end);
    SeamCase<Row32> made{Extent::cube(8), part, seam_layers(all)};
    made.seams.open();
    std::vector<std::tuple<unsigned, unsigned, unsigned>> neg, pos;
    for (unsigned z = neg_begin; z < neg_end; ++z) neg.emplace_back(z, z, z + 1);
    for (unsigned z = pos_begin; z < pos_end; ++z) pos.emplace_back(z, 8 + 2 * z, 10 + 2 * z);
    CHECK(seams_of(made.list, Direction::neg_z) == neg);
    CHECK(seams_of(made.list, Direction::pos_z) == pos);
    // The sweep found no faces in these layers.
    const std::size_t replaced = (neg_end - neg_begin) + 2 * std::size_t{pos_end - pos_begin};
    CHECK(made.closed().quads.size() == 24 - replaced);
  };
  check({3, 5, {}}, 3, 6, 2, 5);
  check({0, 1, {}}, 0, 2, 0, 1);  // no layer lies before the part
  check({7, 8, {}}, 7, 8, 6, 8);  // no layer lies behind it
  check({0, 8, {}}, 0, 8, 0, 8);
}

TEST_CASE("in a part that is the whole chunk all quads are replaced", "[mesh]") {
  const Extent extent = Extent::cube(8);
  SeamCase<Row32> made{extent, SweepPart<Row32>::whole(ordered(extent, AxisOrder::xyz)),
                       seam_layers({{{Direction::pos_x, 2}, {fast_quad(0, 8, 0, 8)}},
                                    {{Direction::pos_y, 3}, {side_quad(0, 8, 0, 8)}}})};
  made.seams.open();
  CHECK(made.list.size() == 6 * 8);  // each layer of each side
  CHECK(made.open_quad(Side::mid_pos, 3, 7) == kUntouched);
  const Quad found = side_quad(1, 2, 3, 4);
  made.put(Direction::pos_y, 3, found);
  CHECK(made.closed().quads == std::vector{found});
}

TEST_CASE("the quads to replace are found among many", "[mesh]") {
  // 0 to 5 quads end in each row. A layer of more than 16 quads is searched by halves.
  std::vector<Quad> side_quads, fast_quads;
  for (unsigned z = 0; z < 128; ++z) {
    for (unsigned x = 0; x < z % 6; ++x) {
      side_quads.push_back(side_quad(2 * x, 1, z, z + 1));
      fast_quads.push_back(fast_quad(2 * x, 1, z, z + 1));
    }
  }
  const auto count = static_cast<unsigned>(fast_quads.size());
  const auto ending_before = [&](unsigned row) {
    unsigned found = 0;
    for (const Quad quad : side_quads) found += kSideShape.row_end(quad) < row ? 1 : 0;
    return found;
  };
  SweepPart<Row128> part{0, 1, {}};
  part.traced[at(Side::mid_pos)] = Row128{1} << 3;
  part.traced[at(Side::fast_pos)] = Row128{1} << 2;
  SeamCase<Row128> made{
      Extent::cube(128), part,
      seam_layers({{{Direction::pos_x, 2}, fast_quads}, {{Direction::pos_y, 3}, side_quads}})};
  for (unsigned begin = 0; begin < 128; ++begin) {
    for (const unsigned end : {begin + 1, begin + 5, 128u}) {
      if (end > 128) continue;
      made.part.begin = begin;
      made.part.end = end;
      made.seams.open();
      const unsigned first = ending_before(begin), behind = ending_before(end + 1);
      CAPTURE(begin, end);
      REQUIRE(seams_of(made.list, Direction::pos_x) == std::vector{std::tuple{2u, first, behind}});
      REQUIRE(seams_of(made.list, Direction::pos_y) ==
              std::vector{std::tuple{3u, count + first, count + behind}});
    }
  }
}

}  // namespace
}  // namespace runstone::rdm
