// The stores as mesher_cases: each set before one volume, ready to be measured.
//   flat           a material a voxel, in the axis order of the runs (flat_array.hpp)
//   morton         the same by Morton code (morton_array.hpp)
//   palette        sections of 16³ with a palette, as Minecraft (palette_store.hpp)
//   runs           the product's runs (run_store.hpp)
//   interval_map   the runs in a balanced tree (interval_map.hpp)
//   octree, dag    sparse voxel octree and DAG (voxel_tree.hpp)
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "tests/bench/storage/store_case.hpp"

namespace runstone::bench::storage {

/// What one repetition measures, ns of core time, in this order: to build from runs; to read a voxel at random;
/// to walk, a voxel; to set one voxel; to paint a ball.
enum class StoreFigure : std::uint8_t { build, read, walk, edit, brush };
inline constexpr std::size_t kStoreFigureCount = 5;

struct StoreContestant {
  std::string_view name;
  std::size_t bytes = 0;                            // all that it keeps, just built
  std::function<std::vector<double>()> repetition;  // figures by StoreFigure
};

/// All names, in the order above.
std::span<const std::string_view> store_names();

/// All stores on one volume, in that order. Requires a storable() chunk; `asked` must outlive them.
std::vector<StoreContestant> make_stores(const StoreCase& asked);

/// Whether Morton codes are made by the instruction pdep here, or by a table.
std::string_view morton_code_maker();

}  // namespace runstone::bench::storage
