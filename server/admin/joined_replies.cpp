#include "server/admin/joined_replies.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace runstone {
namespace {

class JoinedAnswer {
 public:
  JoinedAnswer(CommandReply reply, std::size_t count) : reply_(std::move(reply)), parts_(count) {}

  void take(std::size_t part, const CommandAnswer& answer) {
    if (!answer.is_done && !answer.is_unsaved) return reply_(answer);
    parts_[part] = answer;
    const auto all = [this](auto&& condition) {
      return std::ranges::all_of(parts_,
                                 [&](const auto& each) { return each && condition(*each); });
    };
    if (!all([](const CommandAnswer&) { return true; })) return;
    if (all([](const CommandAnswer& each) { return each.is_done; })) {
      reply_(
          CommandAnswer::last(text(), all([](const CommandAnswer& each) { return each.is_ok; })));
    } else if (!std::exchange(is_reported_, true)) {
      reply_(CommandAnswer::unsaved(text()));
    }
  }

 private:
  /// Requires an answer of each part.
  std::string text() const {
    std::string text;
    for (const auto& each : parts_) text += (text.empty() ? "" : "\n") + each->text;
    return text;
  }

  const CommandReply reply_;
  std::vector<std::optional<CommandAnswer>> parts_;
  bool is_reported_ = false;  // that some are not on disk yet
};

}  // namespace

std::vector<CommandReply> joined_replies(const CommandReply& reply, std::size_t count) {
  if (count == 1) return {reply};
  const auto joined = std::make_shared<JoinedAnswer>(reply, count);
  std::vector<CommandReply> out;
  out.reserve(count);
  for (std::size_t part = 0; part < count; ++part)
    out.emplace_back([joined, part](const CommandAnswer& answer) { joined->take(part, answer); });
  return out;
}

}  // namespace runstone
