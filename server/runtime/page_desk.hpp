// PageDesk: answers the lines that a gateway sends for the operators' page (docs/operators-page.md).
// It checks tokens, and gives commands as the owners of the tokens.
// Threads: take() may be called from any thread.
#pragma once
#include <asio/thread_pool.hpp>
#include <functional>
#include <string>
#include <string_view>

#include "server/admin/access_token_store.hpp"
#include "server/rollback/command_reply.hpp"

namespace runstone {

/// The first line of an answer. Text of a command comes after it, so no command can pretend one.
inline constexpr const char* kPageKnown = "!known";      // the token is in force
inline constexpr const char* kPageUnknown = "!unknown";  // the token or the link is not
inline constexpr const char* kPageBarred = "!barred";  // its owner has no right that the page needs

/// The digits of what forms carry besides the token. It follows from the secret of the token.
std::string page_form_key(std::string_view secret);

/// The most bytes of a line: a command with a token, a form key and the words before them.
inline constexpr std::size_t kPageLineBytesMax = 2'048;

class PageDesk {
 public:
  /// What the desk needs of the running server. The replies may come on any thread.
  struct Server {
    /// Gives a command as the owner of a token. The first answer is one of the lines above.
    std::function<void(const AccessToken&, const std::string& line, CommandReply)> give;
    /// Answers with name, role and rights of the owner of a token, after one of the lines above.
    std::function<void(const AccessToken&, CommandReply)> describe;
    /// Calls `then` with the rights for which the owner of a token may use the page now.
    std::function<void(const AccessToken&, std::function<void(RightSet)> then)> rights;
  };
  /// `tokens` and `workers` must outlive the tasks of the object, which run on `workers`.
  PageDesk(AccessTokenStore& tokens, asio::thread_pool& workers, std::string world_folder,
           Server server);

  /// Answers one line:
  ///   - "enter LINK": "token SECRET" and "ends SECONDS" of a new page token;
  ///   - "who TOKEN": "name NAME", "role ROLE", "rights RIGHTS", "form KEY" and "ends SECONDS";
  ///   - "look TOKEN COMMAND": the answer to a command that changes nothing;
  ///   - "do TOKEN FORM COMMAND": the answer to any command;
  ///   - "picture TOKEN ID before" or "after": the PNG file of a preview, in hex;
  ///   - "leave TOKEN FORM": nothing; the token ends.
  void take(const std::string& line, CommandReply reply);

 private:
  void answer(std::string_view line, const CommandReply& reply);
  void enter(std::string_view link, const CommandReply& reply);
  void answer_known(std::string_view verb, std::string_view rest, const AccessToken& token,
                    std::string_view secret, const CommandReply& reply);
  void send_picture(std::string_view words, const AccessToken& token, const CommandReply& reply);
  void leave(const AccessToken& token, const CommandReply& reply);

  AccessTokenStore& tokens_;
  asio::thread_pool& workers_;
  const std::string previews_;
  const Server server_;
};

}  // namespace runstone
