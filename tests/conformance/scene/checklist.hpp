// Checklist: plays scenes to a client and prints a row for each, and a score.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {

enum class Mark { passed, failed, not_tried };

struct Row {
  Scene scene;
  Mark mark = Mark::not_tried;
  std::string why;  // empty if the client has passed
};

/// Plays the scenes, up to `jobs` at a time, each to a client program of its own. Returns a row for
/// each scene, in their order.
std::vector<Row> play(std::vector<Scene> scenes, const StageOptions& options, unsigned jobs);

/// Prints the rows of both parts and their scores.
void print(const std::vector<Row>& rows, std::ostream& out);
/// Returns the rows as JSON.
std::string json_text(const std::vector<Row>& rows);
/// Returns true if the client has failed no scene, and each scene of the minimum was tried.
bool is_passed(const std::vector<Row>& rows);

}  // namespace runstone::conformance
