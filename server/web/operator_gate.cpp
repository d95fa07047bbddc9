#include "server/web/operator_gate.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "common/core/hex.hpp"
#include "common/os/steady_clock.hpp"
#include "server/web/operator_pages.hpp"
#include "server/web/page_form.hpp"
#include "server/web/page_link.hpp"

namespace runstone {
namespace {

HttpAnswer operator_answer_of(unsigned status, std::string body) {
  HttpAnswer out{status, "text/html; charset=utf-8", std::move(body)};
  out.scripts = PageScripts::forms;
  return out;
}

/// Ends the count of a request that waits, also if its answer ends by an exception.
class WaitingVisit {
 public:
  WaitingVisit(WaitingRequests& waiting, AddressBlock from) : waiting_(waiting), from_(from) {}
  ~WaitingVisit() { waiting_.remove(from_); }
  WaitingVisit(const WaitingVisit&) = delete;
  WaitingVisit& operator=(const WaitingVisit&) = delete;

 private:
  WaitingRequests& waiting_;
  const AddressBlock from_;
};

/// One request under way. The server is asked only for tokens that may be right, and not for an
/// address that has sent many wrong ones.
class OperatorVisit {
 public:
  OperatorVisit(WebState& state, WebWorld& world, OperatorRequest request)
      : state_(state), world_(world), request_(std::move(request)) {}

  boost::asio::awaitable<HttpAnswer> answer() {
    const std::string_view path = path_of(request_.target);
    if (path.size() < kOperatorsPath.size()) {
      HttpAnswer out = plain_answer(308, "the page is one slash further");
      out.location = std::string(kOperatorsPath.substr(1));
      co_return out;
    }
    const std::string section(path.substr(kOperatorsPath.size()));
    HttpAnswer out;
    if (request_.method == "POST") {
      out = co_await answer_form(section);
    } else if (request_.method == "GET" || request_.method == "HEAD") {
      out = co_await answer_look(section);
    } else {
      out = plain_answer(405, "this page takes GET, HEAD and POST");
      out.allow = "GET, HEAD, POST";
    }
    co_return out;
  }

 private:
  const std::string& title() const { return world_.config.title; }
  bool is_encrypted() const { return state_.certificate.is_there(); }
  /// Browsers send cookies to every port of a host, so the name has the port.
  std::string cookie_name() const {
    return std::string(is_encrypted() ? "__Host-" : "") + "runstone-operators-" +
           std::to_string(request_.port) + (world_.name.empty() ? "" : "-" + world_.name);
  }
  std::string cookie_header(const std::string& value) const {
    return cookie_name() + "=" + value + "; Path=/; HttpOnly; SameSite=Strict" +
           (is_encrypted() ? "; Secure" : "") + (value.empty() ? "; Max-Age=0" : "");
  }
  std::string token() const {
    const std::string value = cookie_of(request_.cookie, cookie_name());
    return is_token_text(value) ? value : "";
  }
  HttpAnswer notice(unsigned status, const std::string& heading,
                    const std::string& sentence) const {
    return operator_answer_of(status, operator_notice(title(), heading, sentence));
  }
  HttpAnswer no_token(bool forgets_cookie) const {
    HttpAnswer out = notice(401, "Operators",
                            "You have not entered, or your visit has ended. The host of this world "
                            "makes a link for you: runstone-server control page link PLAYER");
    if (forgets_cookie) out.cookie = cookie_header("");
    return out;
  }
  HttpAnswer barred(const PageReply& reply) const {
    return notice(403, "Operators",
                  reply.lines.empty()
                      ? "Your role has no right for which this page is, or you are banned."
                      : reply.lines.front());
  }
  HttpAnswer down() const {
    return notice(
        503, "Operators",
        "The server of this world is not running, restarts, or has no page for operators.");
  }
  HttpAnswer refusal_of(const PageReply& reply) const {
    if (reply.kind == PageReply::Kind::unknown) return no_token(true);
    if (reply.kind == PageReply::Kind::barred) return barred(reply);
    return down();
  }

  boost::asio::awaitable<PageReply> ask(std::string line) {
    PageReply reply =
        co_await ask_page(state_.io, world_.config.gateway_socket + ".page", std::move(line));
    if (reply.kind == PageReply::Kind::unknown)
      state_.operator_faults.charge_range(request_.from, WebState::kOperatorFaultPrice,
                                          steady_now_us());
    co_return reply;
  }

  /// Returns why a form may not be taken, or nullopt. A page of somebody else can make a browser send
  /// a form, but cannot choose these headers.
  std::optional<HttpAnswer> refusal_of_form() const {
    const bool is_own = request_.origin && *request_.origin != "null" &&
                        state_.own_origin.allows(*request_.origin, request_.host);
    const bool is_same_site = request_.fetch_site.empty() || request_.fetch_site == "same-origin";
    if (!is_own || !is_same_site)
      return plain_answer(403, "only pages of this gateway may send a form here");
    constexpr std::string_view kType = "application/x-www-form-urlencoded";
    if (!request_.content_type.starts_with(kType))
      return plain_answer(415, "a form is application/x-www-form-urlencoded");
    return std::nullopt;
  }

  boost::asio::awaitable<HttpAnswer> answer_form(const std::string& section) {
    if (section != "enter" && section != "do" && section != "leave")
      co_return plain_answer(404, "there is no such form");
    if (auto refused = refusal_of_form()) co_return *std::move(refused);
    const auto fields = parse_form(request_.body);
    if (!fields) co_return plain_answer(400, "the form is malformed");
    if (section == "enter") {
      HttpAnswer entered = co_await enter(field_of(*fields, "link"));
      co_return entered;
    }
    const std::string secret = token(), form = field_of(*fields, "form");
    if (secret.empty()) co_return no_token(false);
    if (!is_token_text(form)) co_return plain_answer(403, "the form is not of this page");
    if (section == "leave") {
      const PageReply left = co_await ask("leave " + secret + " " + form);
      if (!left.is_ok())
        co_return left.kind == PageReply::Kind::known
            ? plain_answer(403, "the form is not of this page")
            : refusal_of(left);
      HttpAnswer out = notice(200, "Operators", "You have left. The token has ended.");
      out.cookie = cookie_header("");
      co_return out;
    }
    HttpAnswer done = co_await carry_out(secret, form, *fields);
    co_return done;
  }

  boost::asio::awaitable<HttpAnswer> enter(const std::string& link) {
    if (!is_token_text(link)) co_return no_link();
    const PageReply reply = co_await ask("enter " + link);
    if (reply.kind == PageReply::Kind::unknown) co_return no_link();
    const std::string secret = reply.value("token");
    if (!reply.is_ok() || !is_token_text(secret)) co_return refusal_of(reply);
    HttpAnswer out = plain_answer(303, "you have entered");
    out.location = "./";
    out.cookie = cookie_header(secret);
    co_return out;
  }
  HttpAnswer no_link() const {
    return notice(
        403, "Operators",
        "This link was used before, has expired, or was never made. Ask for another one.");
  }

  boost::asio::awaitable<HttpAnswer> carry_out(const std::string& secret, const std::string& form,
                                               const FormFields& fields) {
    const PageReply who = co_await ask("who " + secret);
    if (!who.is_ok()) co_return refusal_of(who);
    const OperatorView view = operator_view(title(), who);
    // The server compares it again. Here it keeps a wrong form from showing the page.
    if (form != view.form) co_return plain_answer(403, "the form is not of this page");
    const auto command = command_of_form(fields);
    if (!command) co_return notice(400, "The form is not complete", command.error() + ".");
    const PageReply reply = co_await ask("do " + secret + " " + form + " " + *command);
    if (reply.kind == PageReply::Kind::unknown || reply.kind == PageReply::Kind::barred)
      co_return refusal_of(reply);
    co_return operator_answer_of(200, operator_answer(view, *command, reply));
  }

  boost::asio::awaitable<HttpAnswer> answer_look(const std::string& section) {
    const std::size_t question = request_.target.find('?');
    const auto fields = parse_form(question == std::string::npos
                                       ? std::string_view()
                                       : std::string_view(request_.target).substr(question + 1));
    if (!fields) co_return plain_answer(400, "the address is malformed");
    if (section == "enter") {
      const std::string link = field_of(*fields, "link");
      co_return is_token_text(link) ? operator_answer_of(200, enter_page(title(), link))
                                    : no_link();
    }
    const std::string secret = token();
    if (secret.empty()) co_return no_token(false);
    if (section == "picture") {
      HttpAnswer picture = co_await show_picture(secret, *fields);
      co_return picture;
    }
    constexpr std::array<std::string_view, 6> kSections = {"",    "roles",    "bans",
                                                           "log", "rollback", "command"};
    if (std::ranges::find(kSections, section) == kSections.end())
      co_return plain_answer(404, "there is no such page");
    const PageReply who = co_await ask("who " + secret);
    if (!who.is_ok()) co_return refusal_of(who);
    const OperatorView view = operator_view(title(), who);
    const auto looks = looks_of(view, section, *fields);
    if (!looks) co_return notice(400, "The search is not complete", looks.error() + ".");
    std::vector<OperatorPart> parts;
    for (const auto& [heading, command] : *looks) {
      PageReply reply = co_await ask("look " + secret + " " + command);
      parts.push_back({heading, std::move(reply)});
    }
    co_return operator_answer_of(200, operator_page(view, section, parts, *fields));
  }

  using Looks = std::vector<std::pair<std::string, std::string>>;  // titles and commands
  static Result<Looks, std::string> looks_of(const OperatorView& view, const std::string& section,
                                             const FormFields& fields) {
    Looks out;
    if (section.empty() && view.has("moderate")) out = {{"Server", "status"}};
    if (section.empty()) out.emplace_back("Players", "players");
    if (section == "roles") out = {{"Roles", "roles"}};
    if (section == "roles" && view.has("grant")) out.emplace_back("Grants", "grants");
    if (section == "bans") out = {{"Bans, mutes and freezes", "bans"}};
    if (section == "rollback") out = {{"Previews and rollbacks", "rollback list"}};
    if (section == "log") {
      auto command = log_command_of(fields);
      if (!command) return failure(command.error());
      if (!command->empty()) out.emplace_back("Newest actions", *std::move(command));
    }
    return out;
  }

  boost::asio::awaitable<HttpAnswer> show_picture(const std::string& secret,
                                                  const FormFields& fields) {
    const std::string id = field_of(fields, "id"), which = field_of(fields, "which");
    const bool is_plain = id.find(' ') == std::string::npos && id.size() <= 20;
    if (!is_plain || (which != "before" && which != "after"))
      co_return plain_answer(404, "there is no such picture");
    const PageReply reply = co_await ask("picture " + secret + " " + id + " " + which);
    if (reply.kind != PageReply::Kind::known) co_return refusal_of(reply);
    const std::string hex = reply.lines.empty() ? "" : reply.lines.front();
    std::vector<std::uint8_t> bytes(hex.size() / 2);
    if (!reply.is_ok() || !read_hex(hex, bytes))
      co_return plain_answer(404, "there is no such picture");
    HttpAnswer out{200, "image/png", std::string(bytes.begin(), bytes.end())};
    out.scripts = PageScripts::forms;
    co_return out;
  }

  WebState& state_;
  WebWorld& world_;
  const OperatorRequest request_;
};

}  // namespace

bool is_for_operators(std::string_view path) {
  return path.starts_with(kOperatorsPath) ||
         path == kOperatorsPath.substr(0, kOperatorsPath.size() - 1);
}

boost::asio::awaitable<HttpAnswer> answer_operator(WebState& state, WebWorld& world,
                                                   OperatorRequest request) {
  if (!state.config.operators_page)
    co_return plain_answer(404, "this gateway has no page for operators");
  const AddressBlock from = request.from;
  if (!state.operator_faults.has(from, WebState::kOperatorFaultPrice, steady_now_us()))
    co_return plain_answer(429, "too many wrong links from this address: ask later");
  if (!state.operator_requests.add(from))
    co_return plain_answer(429, "many requests of this address wait: ask later");
  const WaitingVisit counted(state.operator_requests, from);
  OperatorVisit visit(state, world, std::move(request));
  HttpAnswer out = co_await visit.answer();
  co_return out;
}

}  // namespace runstone
