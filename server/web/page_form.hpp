// The forms of the operators' page: what browsers send, and the commands that follow from it. Pure.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

using FormFields = std::map<std::string, std::string>;

/// The most bytes of a form that a browser sends.
inline constexpr std::size_t kFormBytesMax = 16 * 1024;

/// Parses "name=value&..." in the coding of forms (application/x-www-form-urlencoded). Returns
/// nullopt if it is malformed, names a field twice, has more than 32 fields, or has a value that is
/// not printable UTF-8.
std::optional<FormFields> parse_form(std::string_view text);
/// Returns the value of a field without blanks around it, or an empty text.
std::string field_of(const FormFields& fields, const std::string& name);
/// Returns the value of a cookie of the header Cookie, or an empty text if there is none or several.
std::string cookie_of(std::string_view header, std::string_view name);
/// Returns true for a text that may be the secret of a token.
bool is_token_text(std::string_view text);

/// Returns the line of the command that a form orders. The field `action` names the form. Each value
/// becomes one word in quotes, or words of letters, digits and a few signs, so that a value cannot
/// become another command. Only the form `command` takes a whole line. Fails with a sentence about
/// the field that is missing or wrong.
Result<std::string, std::string> command_of_form(const FormFields& fields);
/// Returns the command for a search of the log, or an empty line if no filter is given.
Result<std::string, std::string> log_command_of(const FormFields& fields);

}  // namespace runstone
