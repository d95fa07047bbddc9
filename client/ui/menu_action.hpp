// MenuAction: what the user chose in the menus around the game. The program carries it out.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "client/settings/client_settings.hpp"

namespace runstone {

/// Join a server. `name` is that of the player, here and below. The address is as the user typed
/// it: HOST, HOST:PORT or a link.
struct JoinAddress {
  std::string address, name;
};
/// Join a world on this computer.
struct JoinLocalWorld {
  std::string world, name;
};
/// Make a world on this computer, and join it.
struct MakeLocalWorld {
  std::string world, name, generator;
  std::optional<std::uint64_t> seed;  // nullopt: a random one
};
/// Join the last server again with this password.
struct GivePassword {
  std::string password;
};
struct CancelJoin {};
struct ResumePlay {};
struct LeaveServer {};
struct QuitProgram {};
/// The user changed the settings. They are to be used and kept.
struct ChangeSettings {
  ClientSettings settings;
};

using MenuAction = std::variant<JoinAddress, JoinLocalWorld, MakeLocalWorld, GivePassword,
                                CancelJoin, ResumePlay, LeaveServer, QuitProgram, ChangeSettings>;

}  // namespace runstone
