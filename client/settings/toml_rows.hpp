// TOML rows: the tables of a list such as `[[server]]`, in the files of this folder.
#pragma once
#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

/// Returns the text of a value. Returns nullopt if `node` is null, is no text, has more than
/// `bytes_max` bytes, or cannot be shown in a line (is_printable_utf8()).
std::optional<std::string> line_of(const toml::node* node, std::size_t bytes_max);

/// Calls `act` for each table of the list `list`, in order. Fails with "LINE: WHAT" if the text is
/// no TOML.
Result<void, std::string> each_toml_row(std::string_view toml, std::string_view list,
                                        const std::function<void(const toml::table&)>& act);

/// Calls `act` for each table of the list `list` in a file, in order. A file that is missing, that
/// cannot be read or that has more than `bytes_max` bytes has none. A file that is no TOML has none,
/// too, and is renamed to FILE.broken. Waits for the disk.
void each_row_of_file(const std::string& file, std::size_t bytes_max, std::string_view list,
                      const std::function<void(const toml::table&)>& act);

}  // namespace runstone
