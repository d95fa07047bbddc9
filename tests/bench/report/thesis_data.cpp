#include "tests/bench/report/thesis_data.hpp"

#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "tests/bench/report/rows.hpp"

namespace runstone::bench {
namespace {

template <class T>
std::optional<T> number(const std::string& text) {
  T out{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out);
  return error == std::errc() && stop == end ? std::optional(out) : std::nullopt;
}

/// Calls take(fields) for each line after the first, until it returns false. Returns an error, or
/// an empty text.
template <class Take>
std::string read_table(const std::string& file, std::size_t fields, Take&& take) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) return file + " cannot be read. ";
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::vector<std::string> values;
    std::istringstream parts(line);
    for (std::string part; std::getline(parts, part, ',');) values.push_back(part);
    if (values.size() != fields || !take(values)) {
      return file + " is broken in line " + std::to_string(number) + ". ";
    }
  }
  return "";
}

}  // namespace

ThesisData ThesisData::read(const std::string& folder) {
  ThesisData out;
  const auto result = [&out](const std::vector<std::string>& v) {
    const auto scenario = number<unsigned>(v[0]);
    const auto value = number<double>(v[3]);
    if (scenario && value) out.results_[{*scenario, v[1], v[2]}] = *value;
    return scenario && value;
  };
  const auto size = [&out](const std::vector<std::string>& v) {
    const auto scenario = number<unsigned>(v[0]), side = number<unsigned>(v[1]);
    const auto mean = number<double>(v[3]);
    if (scenario && side && mean) out.sizes_[{*scenario, *side, v[2]}] = *mean;
    return scenario && side && mean;
  };
  out.doubt_ = read_table(folder + "/thesis_results.csv", 5, result);
  out.doubt_ += read_table(folder + "/chunk_sizes.csv", 8, size);
  return out;
}

double ThesisData::value(unsigned scenario, std::string_view mesher,
                         std::string_view metric) const {
  const auto found = results_.find(std::tuple(scenario, mesher, metric));
  return found == results_.end() ? kNoNumber : found->second;
}

double ThesisData::chunk_size_ms(unsigned scenario, unsigned side, std::string_view mesher) const {
  const auto found = sizes_.find(std::tuple(scenario, side, mesher));
  return found == sizes_.end() ? kNoNumber : found->second;
}

}  // namespace runstone::bench
