#include "tests/support/scenarios/thesis_table.hpp"

#include <fstream>
#include <iterator>
#include <sstream>

#include "common/core/assert.hpp"

namespace runstone::test {
namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      out.emplace_back();
    } else if (c != '\r') {
      out.back() += c;
    }
  }
  return out;
}

}  // namespace

std::string thesis_text(const std::string& file) {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/thesis/" + file,
                   std::ios::binary);
  RUNSTONE_ASSERT(in.good());
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<ThesisRow> thesis_table(const std::string& file) {
  std::istringstream lines(thesis_text(file));
  std::string line;
  RUNSTONE_ASSERT(std::getline(lines, line));
  const std::vector<std::string> names = fields_of(line);
  std::vector<ThesisRow> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> fields = fields_of(line);
    RUNSTONE_ASSERT(fields.size() == names.size());
    ThesisRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = fields[i];
  }
  return rows;
}

}  // namespace runstone::test
