#include "client/settings/toml_rows.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "common/core/text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/text_file.hpp"

namespace runstone {

std::optional<std::string> line_of(const toml::node* node, std::size_t bytes_max) {
  auto text = node == nullptr ? std::nullopt : node->value<std::string>();
  if (!text || text->size() > bytes_max || !is_printable_utf8(*text)) return std::nullopt;
  return text;
}

Result<void, std::string> each_toml_row(std::string_view toml, std::string_view list,
                                        const std::function<void(const toml::table&)>& act) {
  try {
    const toml::table root = toml::parse(toml);
    const toml::array* const rows = root[list].as_array();
    if (rows == nullptr) return {};
    for (const toml::node& node : *rows) {
      if (const toml::table* const row = node.as_table()) act(*row);
    }
  } catch (const toml::parse_error& bad) {
    return failure(fmt::format("{}: {}", bad.source().begin.line, bad.description()));
  }
  return {};
}

void each_row_of_file(const std::string& file, std::size_t bytes_max, std::string_view list,
                      const std::function<void(const toml::table&)>& act) {
  std::error_code error;
  if (file.empty() || !std::filesystem::exists(file, error)) return;
  const auto text = read_text_file(file, bytes_max);
  if (!text) return;
  if (!each_toml_row(*text, list, act)) static_cast<void>(set_aside(file));
}

}  // namespace runstone
