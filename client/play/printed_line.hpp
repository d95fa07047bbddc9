// printed_line(): a line of chat as text. Pure.
#pragma once
#include <string>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns a line as it is printed: "<ana> hello", "[server] ...", "[today] ..." for the message of
/// the day, or "[not sent] ..." with the reason why a line of this client was not passed on. Only a
/// line of a player begins with "<", and it begins with the player's name. Characters that
/// with_unseen_replaced() replaces are question marks.
std::string printed_line(const ChatLine& line);

}  // namespace runstone
