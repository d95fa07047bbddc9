#include "tests/support/voxelise/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace runstone::test {
namespace {

constexpr double kTestPi = 3.14159265358979323846;

Place place_of(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

double random_share(SplitMix64& rng) { return static_cast<double>(rng.next() >> 11) / 0x1p53; }

}  // namespace

Model box_mesh(Place low, Place high) {
  Model out;
  for (unsigned i = 0; i < 8; ++i)
    out.positions.push_back({(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                             (i & 4) != 0 ? high[2] : low[2]});
  out.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return out;
}

Model icosphere(Place centre, float radius, int cuts) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<std::array<double, 3>> at = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                           {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                           {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<std::uint32_t, 3>> faces = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                       static_cast<std::uint32_t>(at.size()));
      if (is_new)
        at.push_back(
            {(at[a][0] + at[b][0]) / 2, (at[a][1] + at[b][1]) / 2, (at[a][2] + at[b][2]) / 2});
      return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> next;
    for (const auto& [a, b, c] : faces) {
      // Moved to the sphere below.
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      next.insert(next.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(next);
  }
  Model out;
  for (const auto& p : at) {
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    out.positions.push_back(place_of(centre[0] + radius * p[0] / length,
                                     centre[1] + radius * p[1] / length,
                                     centre[2] + radius * p[2] / length));
  }
  out.triangles = std::move(faces);
  return out;
}

Model torus_mesh(Place centre, float radius, float tube, int around, int along) {
  Model out;
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < along; ++k) {
      const double a = 2 * kTestPi * i / around, b = 2 * kTestPi * k / along;
      const double r = radius + tube * std::cos(b);
      out.positions.push_back(place_of(centre[0] + r * std::cos(a), centre[1] + tube * std::sin(b),
                                       centre[2] + r * std::sin(a)));
    }
  }
  const auto at = [&](int i, int k) {
    return static_cast<std::uint32_t>(i % around * along + k % along);
  };
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < along; ++k) {
      out.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      out.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
  }
  return out;
}

Model star_mesh(int around, int rings,
                const std::function<double(const std::array<double, 3>&)>& radius) {
  Model out;
  const auto add = [&](double polar, double turn) {
    const std::array<double, 3> d{std::sin(polar) * std::cos(turn), std::cos(polar),
                                  std::sin(polar) * std::sin(turn)};
    const double r = radius(d);
    out.positions.push_back(place_of(r * d[0], r * d[1], r * d[2]));
  };
  add(0, 0);
  for (int ring = 1; ring < rings; ++ring) {
    for (int i = 0; i < around; ++i) add(kTestPi * ring / rings, 2 * kTestPi * i / around);
  }
  add(kTestPi, 0);
  const auto at = [&](int ring, int i) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * around + i % around);
  };
  const auto last = static_cast<std::uint32_t>(out.positions.size() - 1);
  for (int i = 0; i < around; ++i) {
    out.triangles.push_back({0, at(1, i + 1), at(1, i)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      out.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      out.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
    out.triangles.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  return out;
}

Model statue_mesh(std::size_t triangles) {
  const int rings = std::max(4, static_cast<int>(std::sqrt(static_cast<double>(triangles) / 4)));
  return star_mesh(2 * rings, rings, [](const std::array<double, 3>& d) {
    return 1 + 0.15 * std::sin(9 * d[0] + 1) * std::sin(7 * d[1]) + 0.08 * std::sin(23 * d[2]) +
           0.03 * std::sin(61 * d[0]) * std::cos(53 * d[1]);
  });
}

Model joined(const std::vector<Model>& meshes) {
  Model out;
  for (const Model& mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    out.positions.insert(out.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& t : mesh.triangles)
      out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return out;
}

Model rotated(Model mesh, SplitMix64& rng) {
  std::array<double, 4> q{};
  double length2 = 0;
  do {
    length2 = 0;
    for (double& v : q) {
      v = 2 * random_share(rng) - 1;
      length2 += v * v;
    }
  } while (length2 > 1 || length2 < 0.01);
  const double s = 2 / length2;
  const auto [w, x, y, z] = q;
  for (Place& p : mesh.positions) {
    p = place_of(
        (1 - s * (y * y + z * z)) * p[0] + s * (x * y - w * z) * p[1] + s * (x * z + w * y) * p[2],
        s * (x * y + w * z) * p[0] + (1 - s * (x * x + z * z)) * p[1] + s * (y * z - w * x) * p[2],
        s * (x * z - w * y) * p[0] + s * (y * z + w * x) * p[1] + (1 - s * (x * x + y * y)) * p[2]);
  }
  return mesh;
}

Model as_soup(const Model& mesh) {
  Model out;
  for (const auto& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(out.positions.size());
    for (const std::uint32_t vertex : t) out.positions.push_back(mesh.positions[vertex]);
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

Model random_closed_mesh(SplitMix64& rng, int side) {
  const auto share = [&](double low, double high) {
    return static_cast<float>(side * (low + (high - low) * random_share(rng)));
  };
  const auto one = [&] {
    const Place centre{share(0.3, 0.7), share(0.3, 0.7), share(0.3, 0.7)};
    switch (rng.below(4)) {
      case 0: {
        Place low{}, high{};
        for (std::size_t i = 0; i < 3; ++i) {
          low[i] = centre[i] - share(0.02, 0.25);
          high[i] = centre[i] + share(0.02, 0.25);
        }
        return box_mesh(low, high);
      }
      case 1:
        return icosphere(centre, share(0.05, 0.3), rng.between(0, 2));
      case 2:
        return torus_mesh(centre, share(0.12, 0.2), share(0.03, 0.1), rng.between(3, 12),
                          rng.between(3, 8));
      default: {
        Model star = star_mesh(rng.between(3, 12), rng.between(2, 8),
                               [&](const auto&) { return share(0.05, 0.3); });
        for (Place& p : star.positions) {
          for (std::size_t i = 0; i < 3; ++i) p[i] += centre[i];
        }
        return star;
      }
    }
  };
  std::vector<Model> meshes;
  for (int i = rng.between(1, 3); i > 0; --i) {
    meshes.push_back(one());
    if (rng.below(2) == 0) meshes.back() = rotated(std::move(meshes.back()), rng);
  }
  Model out = joined(meshes);
  // Often many vertices and edges lie on centres and on planes between voxels.
  constexpr std::array<int, 4> kParts{1, 2, 4, 0};
  if (const int parts = kParts[rng.below(4)]; parts != 0) out = snapped_to(std::move(out), parts);
  return out;
}

Model snapped_to(Model mesh, int parts) {
  for (Place& p : mesh.positions) {
    for (float& v : p) v = std::round(v * static_cast<float>(parts)) / static_cast<float>(parts);
  }
  return mesh;
}

}  // namespace runstone::test
