// Meshes for tests and benchmarks of the voxeliser.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/hash.hpp"
#include "common/models/model.hpp"

namespace runstone::test {

using Place = std::array<float, 3>;

/// A closed box with outward normals.
Model box_mesh(Place low, Place high);
/// A closed sphere: an icosahedron, each triangle of which is cut in four `cuts` times.
Model icosphere(Place centre, float radius, int cuts);
/// A closed torus around the y axis.
Model torus_mesh(Place centre, float radius, float tube, int around, int along);
/// A closed surface of 2 * around * (rings - 1) triangles around the origin. `radius(direction)` is
/// its distance; the direction has length 1.
Model star_mesh(int around, int rings,
                const std::function<double(const std::array<double, 3>&)>& radius);
/// A star mesh with bumps, as a statue has them, of about this many triangles.
Model statue_mesh(std::size_t triangles);
/// The meshes as one, with their triangles in order.
Model joined(const std::vector<Model>& meshes);
/// The mesh turned by a random rotation about the origin.
Model rotated(Model mesh, SplitMix64& rng);
/// The mesh with a vertex for each corner of each triangle, as .stl files have it.
Model as_soup(const Model& mesh);
/// A closed mesh of random kind and size, between 0 and `side` along each axis at most.
Model random_closed_mesh(SplitMix64& rng, int side);
/// Moves each vertex to a multiple of 1/parts.
Model snapped_to(Model mesh, int parts);

}  // namespace runstone::test
