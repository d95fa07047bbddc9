// Planes of faces written as rows of text, for tests.
#pragma once
#include <string>
#include <vector>

#include "common/core/hash.hpp"
#include "tests/reference/face_plane.hpp"

namespace runstone::test {

/// Returns the plane of the rows, from v = 0 upwards, a letter a face along u: '#' stone, '+' dirt,
/// any other letter none. Requires rows of one length.
reference::FacePlane face_plane(const std::vector<std::string>& rows);

/// Returns random rows of up to `side_max` letters and up to `side_max` rows: noise of any density,
/// boxes on top of each other, or both.
std::vector<std::string> random_face_text(SplitMix64& rng, unsigned side_max);

}  // namespace runstone::test
