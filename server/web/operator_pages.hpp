// The HTML of the operators' page. It has no scripts: forms and links do everything. Pure.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "server/web/page_form.hpp"
#include "server/web/page_reply.hpp"

namespace runstone {

/// The folder of the operators' page among the paths of a world.
inline constexpr std::string_view kOperatorsPath = "/operators/";

/// Who uses the page: an answer of the server to "who".
struct OperatorView {
  std::string world, name, role, rights, form;
  bool has(std::string_view right) const;
};
OperatorView operator_view(std::string world, const PageReply& who);

/// A part of a page: a title, and what the server has answered.
struct OperatorPart {
  std::string title;
  PageReply reply;
};

/// Returns a page that says something, without the forms of an operator.
std::string operator_notice(const std::string& world, const std::string& title,
                            const std::string& sentence);
/// Returns the page that exchanges a link when its button is pressed. A program that looks at links
/// in advance presses no button, so it uses no link up.
std::string enter_page(const std::string& world, const std::string& link);
/// Returns the page of a section: "", "roles", "bans", "log", "rollback" or "command".
std::string operator_page(const OperatorView& view, std::string_view section,
                          const std::vector<OperatorPart>& parts, const FormFields& fields);
/// Returns the page with the answer to a command.
std::string operator_answer(const OperatorView& view, const std::string& command,
                            const PageReply& reply);
/// Returns the id of the preview of which an answer names pictures, or an empty text.
std::string pictured_preview(const PageReply& reply);
/// Returns the id of the preview that an answer has made, or an empty text.
std::string made_preview(const PageReply& reply);

}  // namespace runstone
