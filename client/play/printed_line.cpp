#include "client/play/printed_line.hpp"

#include <algorithm>

#include "common/core/text.hpp"

namespace runstone {

std::string printed_line(const ChatLine& line) {
  const std::string text = with_unseen_replaced(line.text);
  switch (line.kind) {
    case ChatLineKind::player: {
      // The name "ana> hello <bea" would read as a line of Ana.
      std::string name = line.name;
      std::replace(name.begin(), name.end(), '<', '(');
      std::replace(name.begin(), name.end(), '>', ')');
      return "<" + name + "> " + text;
    }
    case ChatLineKind::server:
      return "[server] " + text;
    case ChatLineKind::message_of_the_day:
      return "[today] " + text;
    case ChatLineKind::refused:
      return "[not sent] " + text;
  }
  return "[chat] " + text;  // a kind that this client does not know
}

}  // namespace runstone
