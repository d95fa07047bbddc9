// ClientEnd: how the play on one server ended.
#pragma once
#include <string>

#include "client/session/failure_words.hpp"

namespace runstone {

struct ClientEnd {
  int exit_code = 0;  // ExitCode, if the program ends with this
  /// The player left this server. The program goes on with its title screen if it has one.
  bool is_left = false;
  /// The reason of a failure, a line for the player. Empty: none.
  std::string failure = {};
  /// The failure in plain words for the title screen. If the player left, there may be words
  /// without a failure.
  FailureWords words = {};
  bool lacks_password = false;  // the failure is that the world has a password, and none was given
};

}  // namespace runstone
