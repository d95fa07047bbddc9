// Face pictures: layers of faces written as rows of text, for tests of what works on one layer.
#pragma once
#include <string>
#include <vector>

#include "common/core/hash.hpp"
#include "common/mesh/reference/face_layer.hpp"

namespace runstone::test {

/// Rows from v = 0 upwards, a letter a face along u: '#' stone, '+' dirt, anything else none. Between 1 and
/// 128 rows, all as long, 128 at most.
reference::FaceLayer face_layer(const std::vector<std::string>& rows);

/// Seeded rows of up to `side_max` a side: noise of any density, boxes on top of each other, or both.
std::vector<std::string> random_picture(SplitMix64& rng, unsigned side_max);

}  // namespace runstone::test
