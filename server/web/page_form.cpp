#include "server/web/page_form.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr std::size_t kFormFieldsMax = 32;
constexpr std::size_t kFormTokenDigits = 64;

std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
  return std::nullopt;
}

/// Returns the text of a name or value of a form, or nullopt.
std::optional<std::string> decoded_field(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == '+' ? ' ' : text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const auto high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (!high || !low) return std::nullopt;
    out += static_cast<char>(*high * 16 + *low);
    i += 2;
  }
  if (!is_printable_utf8(out)) return std::nullopt;
  return out;
}

/// Fails if the server would not take the line of a command. It would close the connection.
Result<std::string, std::string> line_that_fits(const std::string& line) {
  if (line.size() <= kCommandBytesMax) return line;
  return failure("a command has at most " + std::to_string(kCommandBytesMax) + " bytes");
}

/// Collects the words of a command, and the first fault of a field.
class FormLine {
 public:
  FormLine(const FormFields& fields, std::string begin)
      : fields_(fields), line_(std::move(begin)) {}

  /// Adds one word in quotes. `before`: words in front of it.
  void word(const std::string& name, const std::string& before, bool is_needed) {
    const std::string value = take(name, is_needed);
    if (value.empty()) return;
    if (value.find('"') != std::string::npos) return fault(name + " must have no quotes");
    line_ += before + " \"" + value + "\"";
  }
  /// Adds words of letters, digits and the signs of numbers, times and lists.
  void plain(const std::string& name, const std::string& before, bool is_needed) {
    const std::string value = take(name, is_needed);
    if (value.empty()) return;
    constexpr std::string_view kAllowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-:.,#_ ";
    if (value.find_first_not_of(kAllowed) != std::string::npos)
      return fault(name + " has a character that does not belong there");
    line_ += before + " " + value;
  }
  /// Adds a word if the box of this name is ticked.
  void tick(const std::string& name, const std::string& word) {
    if (!field_of(fields_, name).empty()) line_ += " " + word;
  }
  /// Adds one of some words, which the field chooses.
  void choice(const std::string& name, std::span<const std::string_view> choices) {
    const std::string value = take(name, true);
    if (std::ranges::find(choices, value) == choices.end())
      return fault(name + " is none of the choices");
    line_ += (line_.empty() ? "" : " ") + value;
  }
  /// Adds the filters of the log.
  void filters() {
    word("author", " author", false);
    plain("since", " since", false);
    plain("until", " until", false);
    plain("box", " box", false);
  }
  const std::string& line() const { return line_; }
  Result<std::string, std::string> result() const {
    if (!fault_.empty()) return failure(fault_);
    return line_that_fits(line_);
  }

 private:
  std::string take(const std::string& name, bool is_needed) {
    std::string value = field_of(fields_, name);
    if (value.empty() && is_needed) fault(name + " is missing");
    return value;
  }
  void fault(const std::string& what) {
    if (fault_.empty()) fault_ = what;
  }

  const FormFields& fields_;
  std::string line_, fault_;
};

constexpr std::array<std::string_view, 3> kRestrictions = {"ban", "mute", "freeze"};
constexpr std::array<std::string_view, 3> kLifts = {"unban", "unmute", "unfreeze"};

}  // namespace

std::optional<FormFields> parse_form(std::string_view text) {
  FormFields out;
  while (!text.empty()) {
    const std::string_view part = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(part.size() + 1, text.size()));
    if (part.empty()) continue;
    const std::size_t equals = part.find('=');
    const auto name = decoded_field(part.substr(0, equals));
    const auto value = decoded_field(equals == std::string_view::npos ? std::string_view()
                                                                      : part.substr(equals + 1));
    if (!name || !value || out.size() == kFormFieldsMax) return std::nullopt;
    if (!out.emplace(*name, *value).second) return std::nullopt;
  }
  return out;
}

std::string field_of(const FormFields& fields, const std::string& name) {
  const auto found = fields.find(name);
  if (found == fields.end()) return "";
  const std::size_t begin = found->second.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return found->second.substr(begin, found->second.find_last_not_of(' ') + 1 - begin);
}

std::string cookie_of(std::string_view header, std::string_view name) {
  std::string out;
  while (!header.empty()) {
    std::string_view part = header.substr(0, header.find(';'));
    header.remove_prefix(std::min(part.size() + 1, header.size()));
    part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
    if (!part.starts_with(name) || part.substr(name.size(), 1) != "=") continue;
    if (!out.empty()) return "";
    out = part.substr(name.size() + 1);
  }
  return out;
}

bool is_token_text(std::string_view text) {
  return text.size() == kFormTokenDigits &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Result<std::string, std::string> command_of_form(const FormFields& fields) {
  const std::string action = field_of(fields, "action");
  if (action == "command") {
    const std::string line = field_of(fields, "line");
    if (line.empty()) return failure("type a command");
    return line_that_fits(line);
  }
  const bool is_of_rollback = action == "apply" || action == "cancel" || action == "undo";
  const bool has_choice = action == "restrict" || action == "lift";
  FormLine line(fields, has_choice            ? ""
                        : is_of_rollback      ? "rollback " + action
                        : action == "preview" ? "rollback preview"
                                              : action);
  if (action == "restrict") {
    line.choice("kind", kRestrictions);
    line.word("who", "", true);
    line.plain("for", " for", false);
    line.word("reason", " reason", false);
    line.tick("anyway", "anyway");
  } else if (action == "lift") {
    line.choice("kind", kLifts);
    line.word("who", "", true);
  } else if (action == "kick") {
    line.word("who", "", true);
    line.word("reason", " reason", false);
  } else if (action == "grant") {
    line.word("who", "", true);
    line.word("role", "", true);
    line.plain("for", " for", false);
    line.tick("anyway", "anyway");
  } else if (action == "revoke") {
    line.word("who", "", true);
  } else if (action == "preview") {
    line.filters();
    line.tick("picture", "picture");
    line.tick("anyway", "anyway");
  } else if (is_of_rollback) {
    line.word("id", "", true);
  } else {
    return failure("there is no such form");
  }
  return line.result();
}

Result<std::string, std::string> log_command_of(const FormFields& fields) {
  FormLine line(fields, "log");
  line.filters();
  if (line.line() == "log" && field_of(fields, "limit").empty()) {
    if (auto fault = line.result(); !fault) return fault;
    return std::string();
  }
  line.plain("limit", " limit", false);
  return line.result();
}

}  // namespace runstone
