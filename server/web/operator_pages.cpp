#include "server/web/operator_pages.hpp"

#include <algorithm>
#include <array>

#include "common/core/text.hpp"
#include "server/web/web_pages.hpp"

namespace runstone {
namespace {

struct OperatorSection {
  std::string_view path, title;
  std::array<std::string_view, 2> rights;  // one of these shows it; both empty: every operator
};
constexpr std::array<OperatorSection, 6> kOperatorSections = {{
    {"", "Status", {}},
    {"roles", "Roles", {"grant", "administer"}},
    {"bans", "Bans", {"moderate", "moderate"}},
    {"log", "Log", {"roll_back", "roll_back"}},
    {"rollback", "Rollback", {"roll_back", "roll_back"}},
    {"command", "Command", {}},
}};

std::string shown_line(const std::string& line) {
  return html_text(is_printable_utf8(line) ? with_unseen_replaced(line) : "(not printable)");
}

std::string operator_html(const std::string& world, const std::string& title,
                          const std::string& body) {
  const std::string whole = html_text(world + ": " + title);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         whole + "</title>\n<link rel=\"stylesheet\" href=\"../style.css\">\n</head>\n<body>\n" +
         body + "</body>\n</html>\n";
}

std::string operator_header(const OperatorView& view, std::string_view here) {
  std::string out = "<header>\n<p>" + shown_line(view.name) + ", " + shown_line(view.role) +
                    "</p>\n<nav aria-label=\"Sections\">\n<ul class=\"nav\">\n";
  for (const OperatorSection& section : kOperatorSections) {
    const bool is_shown =
        section.rights[0].empty() || view.has(section.rights[0]) || view.has(section.rights[1]);
    if (!is_shown) continue;
    out += "<li><a href=\"./" + std::string(section.path) + "\"" +
           (section.path == here ? " aria-current=\"page\"" : "") + ">" +
           std::string(section.title) + "</a></li>\n";
  }
  return out + "</ul>\n</nav>\n</header>\n";
}

/// Begins a form that orders a command.
std::string form_begin(const OperatorView& view, const std::string& action) {
  return "<form method=\"post\" action=\"do\">\n<input type=\"hidden\" name=\"form\" value=\"" +
         html_text(view.form) + "\">\n<input type=\"hidden\" name=\"action\" value=\"" + action +
         "\">\n";
}
std::string text_input(const std::string& label, const std::string& name, bool is_needed,
                       const std::string& value = "") {
  return "<label>" + label + " <input type=\"text\" name=\"" + name + "\" value=\"" +
         html_text(value) + "\"" + (is_needed ? " required" : "") +
         " autocomplete=\"off\"></label>\n";
}
std::string tick_box(const std::string& label, const std::string& name) {
  return "<label class=\"tick\"><input type=\"checkbox\" name=\"" + name + "\" value=\"1\"> " +
         label + "</label>\n";
}
std::string choice_input(const std::string& label, const std::string& name,
                         std::initializer_list<const char*> choices) {
  std::string out = "<label>" + label + " <select name=\"" + name + "\">";
  for (const char* choice : choices) out += std::string("<option>") + choice + "</option>";
  return out + "</select></label>\n";
}
std::string button(const std::string& text) {
  return "<button type=\"submit\">" + text + "</button>\n";
}
std::string form_of(const OperatorView& view, const std::string& action, const std::string& title,
                    const std::string& inputs) {
  return "<h2>" + title + "</h2>\n" + form_begin(view, action) + inputs + button(title) +
         "</form>\n";
}

std::string answer_block(const PageReply& reply) {
  std::string out;
  if (reply.kind == PageReply::Kind::is_down)
    return "<p class=\"down\">The server gave no answer: it is not running, or it restarts.</p>\n";
  if (reply.kind != PageReply::Kind::known)
    return "<p class=\"down\">Your rights have changed: load the page again.</p>\n";
  if (reply.end == PageReply::End::refused) out += "<p class=\"down\">Refused:</p>\n";
  if (reply.end == PageReply::End::unsaved)
    out += "<p class=\"down\">In force, and not on disk yet.</p>\n";
  if (reply.end == PageReply::End::late)
    out += "<p class=\"down\">The server has not finished. It goes on without this page.</p>\n";
  out += "<pre tabindex=\"0\">";
  for (const std::string& line : reply.lines) out += shown_line(line) + "\n";
  return out + "</pre>\n";
}

std::string filter_inputs(const FormFields& fields) {
  return text_input("Author: a name, #N or a pattern such as grief*", "author", false,
                    field_of(fields, "author")) +
         text_input("Since: an age such as 2h, or a time in UTC", "since", false,
                    field_of(fields, "since")) +
         text_input("Until", "until", false, field_of(fields, "until")) +
         text_input("Box: X Y Z X Y Z", "box", false, field_of(fields, "box"));
}

std::string section_forms(const OperatorView& view, std::string_view section,
                          const FormFields& fields) {
  const std::string anyway = tick_box("anyway, after a warning", "anyway");
  if (section == "bans")
    return form_of(view, "restrict", "Restrict",
                   choice_input("What", "kind", {"ban", "mute", "freeze"}) +
                       text_input("Who: a player, an address or a range", "who", true) +
                       text_input("For: such as 2h; empty: without an end", "for", false) +
                       text_input("Reason", "reason", false) + anyway) +
           form_of(view, "lift", "Lift",
                   choice_input("What", "kind", {"unban", "unmute", "unfreeze"}) +
                       text_input("Who", "who", true)) +
           form_of(view, "kick", "Kick",
                   text_input("Who", "who", true) + text_input("Reason", "reason", false));
  if (section == "roles" && view.has("grant"))
    return form_of(view, "grant", "Grant",
                   text_input("Player", "who", true) + text_input("Role", "role", true) +
                       text_input("For: such as 2h; empty: without an end", "for", false) +
                       anyway) +
           form_of(view, "revoke", "Revoke", text_input("Player", "who", true));
  if (section == "log")
    return "<h2>Search</h2>\n<form method=\"get\" action=\"log\">\n" + filter_inputs(fields) +
           text_input("Limit", "limit", false, field_of(fields, "limit")) + button("Search") +
           "</form>\n";
  if (section == "rollback")
    return form_of(view, "preview", "Preview",
                   filter_inputs(fields) +
                       tick_box("with pictures of before and after", "picture") + anyway) +
           form_of(view, "apply", "Apply", text_input("Preview, such as p1", "id", true)) +
           form_of(view, "cancel", "Cancel", text_input("Preview", "id", true)) +
           form_of(view, "undo", "Undo", text_input("Rollback", "id", true));
  if (section == "command")
    return "<p><code>help</code> lists what you may do.</p>\n" +
           form_of(view, "command", "Give", text_input("Command", "line", true));
  return "";
}

std::string leave_form(const OperatorView& view) {
  return "<form method=\"post\" action=\"leave\">\n<input type=\"hidden\" name=\"form\" value=\"" +
         html_text(view.form) + "\">\n" + button("Leave") + "</form>\n";
}

bool is_id_of_preview(std::string_view id) {
  return id.size() > 1 && id.size() <= 20 && id[0] == 'p' &&
         id.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Returns the id between two texts of a line, or an empty text.
std::string id_between(const std::string& line, std::string_view before, std::string_view after) {
  const std::size_t end = line.rfind(after);
  if (end == std::string::npos) return "";
  const std::size_t begin = line.rfind(before, end);
  if (begin == std::string::npos || begin + before.size() > end) return "";
  const std::string id = line.substr(begin + before.size(), end - begin - before.size());
  return is_id_of_preview(id) ? id : "";
}

}  // namespace

bool OperatorView::has(std::string_view right) const {
  std::string_view rest = rights;
  while (!rest.empty()) {
    const std::string_view each = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(each.size() + 1, rest.size()));
    if (each == right) return true;
  }
  return false;
}

OperatorView operator_view(std::string world, const PageReply& who) {
  return {std::move(world), who.value("name"), who.value("role"), who.value("rights"),
          who.value("form")};
}

std::string operator_notice(const std::string& world, const std::string& title,
                            const std::string& sentence) {
  return operator_html(world, title,
                       "<h1>" + html_text(title) + "</h1>\n<p>" + html_text(sentence) +
                           "</p>\n<p><a href=\"../\">To the world</a></p>\n");
}

std::string enter_page(const std::string& world, const std::string& link) {
  return operator_html(world, "operators",
                       "<h1>Operators of " + html_text(world) +
                           "</h1>\n<form method=\"post\" action=\"enter\">\n<input type=\"hidden\" "
                           "name=\"link\" value=\"" +
                           html_text(link) + "\">\n" + button("Enter") +
                           "</form>\n<p>This link works once.</p>\n");
}

std::string operator_page(const OperatorView& view, std::string_view section,
                          const std::vector<OperatorPart>& parts, const FormFields& fields) {
  std::string title;
  for (const OperatorSection& each : kOperatorSections) {
    if (each.path == section) title = each.title;
  }
  std::string body = operator_header(view, section) + "<main>\n<h1>" + title + "</h1>\n";
  const bool is_search = section == "log";
  if (is_search) body += section_forms(view, section, fields);
  for (const OperatorPart& part : parts)
    body += "<h2>" + part.title + "</h2>\n" + answer_block(part.reply);
  if (!is_search) body += section_forms(view, section, fields);
  return operator_html(view.world, title, body + "</main>\n" + leave_form(view));
}

std::string operator_answer(const OperatorView& view, const std::string& command,
                            const PageReply& reply) {
  std::string body = operator_header(view, "-") + "<main>\n<h1>Answer</h1>\n<p><code>" +
                     shown_line(command) + "</code></p>\n" + answer_block(reply);
  if (const std::string id = pictured_preview(reply); !id.empty()) {
    for (const char* which : {"before", "after"})
      body += "<figure><img src=\"picture?id=" + id + "&amp;which=" + which + "\" alt=\"" + which +
              " the rollback\"><figcaption>" + which + "</figcaption></figure>\n";
  }
  // Answers to other commands may have lines that players have written.
  const bool is_of_preview = command.starts_with("rollback preview");
  if (const std::string id = made_preview(reply); is_of_preview && !id.empty()) {
    for (const char* action : {"apply", "cancel"})
      body += form_begin(view, action) + "<input type=\"hidden\" name=\"id\" value=\"" + id +
              "\">\n" + button(std::string(action) + " " + id) + "</form>\n";
  }
  return operator_html(view.world, "answer", body + "</main>\n" + leave_form(view));
}

std::string pictured_preview(const PageReply& reply) {
  for (const std::string& line : reply.lines) {
    if (!line.starts_with("pictures ")) continue;
    const std::string id = id_between(line, " and ", "-after.png");
    if (!id.empty()) return id;
  }
  return "";
}

std::string made_preview(const PageReply& reply) {
  for (const std::string& line : reply.lines) {
    if (!line.starts_with("nothing has changed yet: ")) continue;
    const std::string id = id_between(line, "`rollback apply ", "` does it");
    if (!id.empty()) return id;
  }
  return "";
}

}  // namespace runstone
