#include "bench/meshing/mesh_targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

/// Returns the rows of a mesher in best order, of one world and edge, if they have a ratio.
std::vector<const MeshRow*> product_rows(const std::vector<MeshRow>& rows, const std::string& world,
                                         unsigned edge, const std::string& mesher = "rdm") {
  std::vector<const MeshRow*> out;
  for (const MeshRow& row : rows) {
    if (row.mesher == mesher && row.rank == "best" && row.world == world && row.edge == edge &&
        row.against_decode) {
      out.push_back(&row);
    }
  }
  return out;
}

Target judged(std::string what, std::string wanted, std::string measured, bool met) {
  return {std::move(what), std::move(wanted), std::move(measured),
          met ? Verdict::met : Verdict::missed};
}

Target unknown(std::string what, std::string wanted = "–") {
  return {std::move(what), std::move(wanted), "–", Verdict::not_measured};
}

/// Compares one volume with decode + binary greedy and with binary greedy with its mask ready.
Target landscape(const std::vector<MeshRow>& rows, const std::string& world) {
  const std::string what =
      world + ", 62³ plus border: against decode + binary greedy; against its mask ready";
  const auto of = product_rows(rows, world, 62);
  if (of.empty() || !of[0]->against_mask) return unknown(what);
  const double a = *of[0]->against_decode, b = *of[0]->against_mask;
  std::string measured = fmt::format("{:.2f}x; {:.2f}x", a, b);
  if (const auto kept = product_rows(rows, world, 62, "rdm_kept"); !kept.empty()) {
    measured += fmt::format(" (borders kept: {:.2f}x; {:.2f}x)", *kept[0]->against_decode,
                            kept[0]->against_mask.value_or(0));
  }
  return without_target(what, measured);
}

/// Judges the baseline: ratios have a meaning only if the baseline is good.
Target baseline(const std::vector<MeshRow>& rows) {
  const std::string what = "our binary greedy itself: hills, 62³, its mask ready";
  for (const MeshRow& row : rows) {
    if (row.mesher != "mask_binary" || row.rank != "best" || row.world != "hills" || row.edge != 62)
      continue;
    const double us = row.timing.median_ns / 1000;
    return judged(what, "at most 120 µs", fmt::format("{:.1f} µs", us), us <= 120);
  }
  return unknown(what, "at most 120 µs");
}

/// The ratios of a baseline's times to ours, over the volumes that have exposed faces.
struct Ratios {
  std::vector<double> each;
  double of_sums = 0;
  double mean() const { return geometric_mean(each); }
  std::string text() const { return fmt::format("{:.2f}x; {:.2f}x", mean(), of_sums); }
};
Ratios ratios_of(const std::vector<const MeshRow*>& of,
                 std::optional<double> MeshRow::* against = &MeshRow::against_decode) {
  Ratios out;
  double ours = 0, theirs = 0;
  for (const MeshRow* row : of) {
    if (!row->has_faces) continue;
    const double ratio = (row->*against).value_or(0);
    out.each.push_back(ratio);
    ours += row->timing.median_ns;
    theirs += ratio * row->timing.median_ns;
  }
  out.of_sums = theirs / ours;
  return out;
}

/// Compares the volumes of the real world as the client meshes them, with kept borders, and names
/// the ratios without.
Target luanti(const std::vector<MeshRow>& rows, unsigned edge, const char* baseline,
              std::optional<double> MeshRow::* against) {
  const std::string what = fmt::format(
      "luanti, all non-uniform {}³ volumes, borders kept, against {}: geometric mean; ratio of sums",
      edge, baseline);
  const auto kept = product_rows(rows, "luanti", edge, "rdm_kept");
  const auto read = product_rows(rows, "luanti", edge);
  if (kept.empty() || read.empty() || !(kept[0]->*against)) return unknown(what);
  return without_target(
      fmt::format("{} ({} volumes)", what, kept.size()),
      fmt::format("{} (borders read from runs: {})", ratios_of(kept, against).text(),
                  ratios_of(read, against).text()));
}

Target scenarios(const std::vector<MeshRow>& rows) {
  const std::string what =
      "the scenarios with exposed faces, edge 32, real neighbours: geometric mean; at least 2x";
  const auto of = product_rows(rows, "scenarios", 32);
  if (of.empty()) return unknown(what);
  const Ratios ratios = ratios_of(of);
  const auto twice =
      std::count_if(ratios.each.begin(), ratios.each.end(), [](double r) { return r >= 2; });
  const double lowest = *std::min_element(ratios.each.begin(), ratios.each.end());
  return without_target(what, fmt::format("{:.2f}x; in {} of {}, lowest {:.2f}x", ratios.mean(),
                                          twice, ratios.each.size(), lowest));
}

/// Returns the lowest ratio of all cells, for every world and axis order, with borders kept and not
/// kept.
Target never_below(const std::vector<MeshRow>& rows) {
  const std::string what = "anything, against decode + binary greedy: the lowest";
  const MeshRow* lowest = nullptr;
  std::size_t cells = 0;
  for (const MeshRow& row : rows) {
    if ((row.mesher != "rdm" && row.mesher != "rdm_kept") || !row.against_decode) continue;
    ++cells;
    if (lowest == nullptr || *row.against_decode < *lowest->against_decode) lowest = &row;
  }
  if (lowest == nullptr) return unknown(what);
  return without_target(
      fmt::format("{} of {} cells", what, cells),
      fmt::format("{:.2f}x ({} {}, edge {}, {} order, {})", *lowest->against_decode, lowest->world,
                  lowest->part, lowest->edge, lowest->rank, lowest->mesher));
}

/// Compares the quads of the product with those of binary greedy: the highest ratio of a world's
/// volumes together, and of one volume.
Target quads(const std::vector<MeshRow>& rows) {
  const std::string what =
      "quads against binary greedy, a world's volumes together: the highest; of a single volume";
  using World = std::pair<std::string, unsigned>;
  struct Counts {
    double ours = 0, theirs = 0;
    double ratio() const { return theirs == 0 ? 1 : ours / theirs; }
  };
  std::map<World, Counts> by_world;
  std::map<std::tuple<std::string, unsigned, std::string>, Counts> by_volume;
  for (const MeshRow& row : rows) {
    if (row.rank != "best" || (row.mesher != "rdm" && row.mesher != "decode_binary")) continue;
    const auto count = static_cast<double>(row.timing.quads);
    for (Counts* to :
         {&by_world[{row.world, row.edge}], &by_volume[{row.world, row.edge, row.part}]}) {
      (row.mesher == "rdm" ? to->ours : to->theirs) += count;
    }
  }
  std::erase_if(by_world, [](const auto& entry) { return entry.second.theirs == 0; });
  if (by_world.empty()) return unknown(what);
  std::erase_if(by_volume, [](const auto& entry) { return entry.second.theirs == 0; });
  const auto less = [](const auto& a, const auto& b) {
    return a.second.ratio() < b.second.ratio();
  };
  const auto world = std::max_element(by_world.begin(), by_world.end(), less);
  const auto volume = std::max_element(by_volume.begin(), by_volume.end(), less);
  return without_target(
      what,
      fmt::format("{:.3f}x ({}, edge {}); {:.3f}x ({} {}, edge {}: {:.0f} and {:.0f})",
                  world->second.ratio(), world->first.first, world->first.second,
                  volume->second.ratio(), std::get<0>(volume->first), std::get<2>(volume->first),
                  std::get<1>(volume->first), volume->second.ours, volume->second.theirs));
}

Target uniform(const std::vector<MeshRow>& rows) {
  const std::string what = "uniform chunk with uniform neighbours: solid; empty";
  double worst = 0;
  std::string measured;
  for (const char* world : {"uniform", "empty"}) {
    double slowest = 0;
    for (const MeshRow& row : rows) {
      if (row.mesher == "rdm" && row.world == world)
        slowest = std::max(slowest, row.timing.median_ns);
    }
    if (slowest == 0) return unknown(what, "under 100 ns");
    measured += fmt::format("{}{:.0f} ns", measured.empty() ? "" : "; ", slowest);
    worst = std::max(worst, slowest);
  }
  return judged(what, "under 100 ns", measured, worst < 100);
}

Target edit(const EditTiming& edits) {
  const std::string what =
      "single-voxel edit, luanti edge 32: splice and remesh, neighbours included; "
      "share of a full mesh";
  if (edits.edits == 0) return unknown(what);
  const double share = edits.all_ns / edits.full_mesh_ns;
  return without_target(
      fmt::format("{} ({} edits, {} at a border)", what, edits.edits, edits.at_borders),
      fmt::format("{:.2f} µs ({:.2f} its own chunk: {:.2f} splice, {:.2f} remesh; "
                  "{:.2f} at a border); {:.2f} of {:.2f} µs",
                  edits.all_ns / 1000, edits.chunk_ns / 1000, edits.apply_ns / 1000,
                  edits.remesh_ns / 1000, edits.border_all_ns / 1000, share,
                  edits.full_mesh_ns / 1000));
}

Target storage(const std::vector<MeshRow>& rows) {
  const std::string what =
      "runs' storage over the 37 scenarios against 2 bytes a voxel: mean saving";
  const auto of = product_rows(rows, "scenarios", 32);
  if (of.empty()) return unknown(what, "80 %");
  double saving = 0;
  for (const MeshRow* row : of) {
    saving += 1 - static_cast<double>(row->timing.storage_bytes) /
                      (2.0 * row->edge * row->edge * row->edge);
  }
  saving /= static_cast<double>(of.size());
  return judged(what, "80 %", fmt::format("{:.1f} %", 100 * saving), saving >= 0.8);
}

}  // namespace

Target shapes_target(const ShapesTiming& shapes) {
  const double ratio = shapes.shapes_ns / shapes.cubes_ns;
  const std::string what =
      fmt::format("a village of {:.0f} % shapes, {} chunks of 32³: against all of it as cubes",
                  100 * shapes.share, shapes.chunks);
  const std::string measured =
      fmt::format("{:.2f}x ({:.1f} and {:.1f} µs a chunk; {} quads, {} of shapes, and {})", ratio,
                  shapes.shapes_ns / 1000, shapes.cubes_ns / 1000, shapes.quads,
                  shapes.quads_of_shapes, shapes.cube_quads);
  return judged(what, "at most 2x", measured, ratio <= 2);
}

std::vector<Target> mesh_targets(const std::vector<MeshRow>& rows, const EditTiming& edits) {
  constexpr const char* kDecode = "decode + binary greedy";
  constexpr const char* kMask = "binary greedy with its mask ready";
  return {landscape(rows, "hills"),
          landscape(rows, "overhangs"),
          landscape(rows, "caves"),
          landscape(rows, "town"),
          luanti(rows, 62, kDecode, &MeshRow::against_decode),
          luanti(rows, 62, kMask, &MeshRow::against_mask),
          luanti(rows, 32, kDecode, &MeshRow::against_decode),
          luanti(rows, 32, kMask, &MeshRow::against_mask),
          scenarios(rows),
          never_below(rows),
          quads(rows),
          uniform(rows),
          edit(edits),
          storage(rows),
          baseline(rows)};
}

}  // namespace runstone::bench
