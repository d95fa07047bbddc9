// MenuState: the contents of the menus around the game. It is plain data; texts are ready to be
// drawn.
#pragma once
#include <string>
#include <vector>

#include "client/settings/client_settings.hpp"

namespace runstone {

struct ListedServer {
  std::string address, name;  // name: of the player there
  std::string joined;         // when, in words
};
struct ListedWorld {
  std::string name;
  std::string changed;  // when, in words
};

/// A failure in words for the player.
struct ShownFailure {
  std::string headline, detail;
};

struct TitleState {
  std::vector<ListedServer> servers;  // newest first
  std::vector<ListedWorld> worlds;    // newest first
  std::string name;                   // of the player
  std::string identity;               // fingerprint of the key, or why there is none
  std::string key_file;
  std::string first_world;       // the name that the button "Build here" gives a new world
  ShownFailure failure;          // of the last attempt; an empty headline: none
  std::string asks_password_of;  // address of the server that asks for a password; empty: none
  std::string notice;            // for example that a world is being saved; empty: none
};

struct ConnectingState {
  std::string to;        // the address or world
  std::string step;      // what happens now
  std::string detail;    // for example why the last attempt failed
  double progress = -1;  // 0 to 1; negative: unknown
};

struct PauseState {
  std::string where;  // the address or world
  std::string players;
  bool is_local = false;
};

}  // namespace runstone
