#include "server/admin/allow_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "common/os/text_file.hpp"

namespace runstone {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string trimmed_entry(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) + 1 - first));
}

/// Takes the next line of a text, without its end.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// Returns the fields of a line of CSV. A quote that is not closed ends with the line.
std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool is_quoted = false, was_quoted = false;
  const auto end_field = [&] {
    if (!was_quoted) fields.back() = trimmed_entry(fields.back());
    was_quoted = false;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool is_doubled = is_quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"';
    if (is_doubled) {
      fields.back() += line[++i];
    } else if (c == '"' && (is_quoted || trimmed_entry(fields.back()).empty())) {
      if (!is_quoted) fields.back().clear();
      is_quoted = !is_quoted;
      was_quoted = true;
    } else if (!is_quoted && (c == ',' || c == ';')) {
      end_field();
      fields.emplace_back();
    } else if (is_quoted || !was_quoted) {
      fields.back() += c;
    }
  }
  end_field();
  return fields;
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// Returns the column of the names if the fields are the head of a table, or nullopt.
std::optional<std::size_t> column_of_names(const std::vector<std::string>& fields) {
  for (const char* head : {"name", "username"}) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (lower_case(fields[i]) == head) return i;
    }
  }
  return std::nullopt;
}

Unexpected<std::string> too_many_entries() {
  return failure("has more than " + std::to_string(kAllowEntriesMax) + " entries: divide it");
}

Result<AllowList, std::string> parse_lines(std::string_view text, bool is_csv) {
  AllowList list;
  std::size_t column = 0;
  bool is_first = true;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string line = trimmed_entry(take_line(text));
    if (line.empty() || line.starts_with('#')) continue;
    AllowEntry entry{number, line, ""};
    if (is_csv) {
      const std::vector<std::string> fields = csv_fields(line);
      const auto head = std::exchange(is_first, false) ? column_of_names(fields) : std::nullopt;
      if (head) {
        column = *head;
        continue;
      }
      entry.name = column < fields.size() ? fields[column] : "";
      if (entry.name.empty()) entry.fault = "has no name";
    }
    if (list.entries.size() == kAllowEntriesMax) return too_many_entries();
    list.entries.push_back(std::move(entry));
  }
  return list;
}

Result<AllowList, std::string> parse_json(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return failure("is no valid JSON");
  if (!json.is_array()) return failure("is JSON, but no list of objects with a name");
  if (json.size() > kAllowEntriesMax) return too_many_entries();
  AllowList list;
  list.unit = "entry";
  for (const auto& object : json) {
    AllowEntry entry{list.entries.size() + 1, "", ""};
    const auto name = object.is_object() ? object.find("name") : object.end();
    if (object.is_object() && name != object.end() && name->is_string())
      entry.name = trimmed_entry(name->get_ref<const std::string&>());
    if (entry.name.empty()) entry.fault = "has no name";
    list.entries.push_back(std::move(entry));
  }
  return list;
}

}  // namespace

Result<AllowList, std::string> parse_allow_list(std::string_view text, bool is_csv) {
  const auto first = text.find_first_not_of(" \t\r\n");
  const bool is_json =
      first != std::string_view::npos && (text[first] == '[' || text[first] == '{');
  return is_json && !is_csv ? parse_json(text) : parse_lines(text, is_csv);
}

Result<AllowList, std::string> read_allow_file(const std::string& file) {
  const auto text = read_text_file(file, kAllowFileBytesMax, FileKinds::regular);
  if (!text) return failure(text.error());
  auto list = parse_allow_list(*text, lower_case(file).ends_with(".csv"));
  if (!list) return failure(file + ": " + list.error());
  return list;
}

}  // namespace runstone
