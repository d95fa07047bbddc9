// The stores as cases to measure, each with one volume.
//   flat           one material a voxel, in the axis order of the runs (flat_array.hpp)
//   morton         the same by Morton code (morton_array.hpp)
//   palette        sections of 16³ with a palette, as in Minecraft (palette_store.hpp)
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

#include "bench/storage/store_case.hpp"

namespace runstone::bench::storage {

/// The figures of one repetition, in ns of processor time, in this order: build from runs; read a
/// random voxel; walk, per voxel; set one voxel; paint a ball.
enum class StoreFigure : std::uint8_t { build, read, walk, edit, brush };
inline constexpr std::size_t kStoreFigureCount = 5;

struct MeasuredStore {
  std::string_view name;
  std::size_t bytes = 0;                            // all that the store keeps, just built
  std::function<std::vector<double>()> repetition;  // returns figures by StoreFigure
};

/// Returns all names, in the order above.
std::span<const std::string_view> store_names();

/// Returns all stores on one volume, in that order. Requires a storable() chunk; `input` must
/// outlive them.
std::vector<MeasuredStore> make_stores(const StoreCase& input);

/// Returns "pdep" or "table": how Morton codes are made on this machine.
std::string_view morton_code_maker();

}  // namespace runstone::bench::storage
