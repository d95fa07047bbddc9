#include "tests/conformance/scene/checklist.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <thread>
#include <utility>

namespace runstone::conformance {
namespace {

const char* word_of(Mark mark) {
  return mark == Mark::passed ? "passed" : mark == Mark::failed ? "failed" : "not tried";
}
const char* word_of(Part part) { return part == Part::minimum ? "minimum" : "further"; }

void play_row(Row& row, const StageOptions& options) {
  try {
    Stage stage(options);
    row.scene.play(stage);
    row.mark = Mark::passed;
  } catch (const SceneFailed& failed) {
    row.mark = Mark::failed;
    row.why = failed.why;
  } catch (const SceneUntried& untried) {
    row.mark = Mark::not_tried;
    row.why = untried.why;
  } catch (const std::exception& error) {
    row.mark = Mark::failed;
    row.why = error.what();
  }
}

void print_part(const std::vector<Row>& rows, Part part, std::ostream& out) {
  std::size_t passed = 0, failed = 0, untried = 0;
  out << word_of(part) << '\n';
  for (const Row& row : rows) {
    if (row.scene.part != part) continue;
    passed += row.mark == Mark::passed;
    failed += row.mark == Mark::failed;
    untried += row.mark == Mark::not_tried;
    out << "  " << std::left << std::setw(10) << word_of(row.mark) << std::setw(23)
        << row.scene.name << row.scene.words << " [" << row.scene.section << "]\n";
    if (!row.why.empty()) out << "            " << row.why << '\n';
  }
  out << "  score: " << passed << " of " << passed + failed;
  if (untried > 0) out << ", " << untried << " not tried";
  out << '\n';
}

}  // namespace

std::vector<Row> play(std::vector<Scene> scenes, const StageOptions& options, unsigned jobs) {
  std::vector<Row> rows;
  for (Scene& scene : scenes) rows.push_back({std::move(scene), Mark::not_tried, {}});
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < rows.size(); i = next++) play_row(rows[i], options);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  return rows;
}

void print(const std::vector<Row>& rows, std::ostream& out) {
  for (const Part part : {Part::minimum, Part::further}) {
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const Row& row) { return row.scene.part == part; }))
      print_part(rows, part, out);
  }
}

std::string json_text(const std::vector<Row>& rows) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    nlohmann::ordered_json entry;
    entry["scene"] = row.scene.name;
    entry["part"] = word_of(row.scene.part);
    entry["section"] = row.scene.section;
    entry["what"] = row.scene.words;
    entry["mark"] = word_of(row.mark);
    entry["why"] = row.why;
    out.push_back(std::move(entry));
  }
  return out.dump(1) + "\n";
}

bool is_passed(const std::vector<Row>& rows) {
  return std::none_of(rows.begin(), rows.end(), [](const Row& row) {
    return row.mark == Mark::failed ||
           (row.mark == Mark::not_tried && row.scene.part == Part::minimum);
  });
}

}  // namespace runstone::conformance
