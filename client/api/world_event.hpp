// WorldEvent: what happened to a WorldClient. WorldClient::drain() returns the events.
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "client/api/mesh_source.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// The number of an edit of this client, ascending from 1.
using EditNumber = ClientSequence;

/// The world is open: for the first time, after a lost connection, or because the server opened
/// another one. WorldClient::world() describes it.
struct WorldOpened {
  /// Not the world that was open before. All chunks and edits of that one are gone.
  bool is_another = false;
  /// The key of the server was not known for this world. A player compares
  /// ClientWorld::server_fingerprint with that of the host.
  bool is_first_contact = false;
};

/// A connection ended, or could not be made. The chunks and the edits stay.
struct ConnectionLost {
  /// A sentence for the player, without a full stop.
  std::string headline;
  /// The exact reason by the server or the system; may be empty.
  std::string detail;
  /// The client does not connect again: another attempt with the same options is pointless, for
  /// example because the password is wrong.
  bool is_final = false;
  /// The world has a password, and the options have none.
  bool lacks_password = false;
};

/// Why a chunk has to be meshed again.
enum class ChangeCause : std::uint8_t {
  terrain,      // the chunk or a neighbour arrived or left, or materials changed
  others_edit,  // edits of others
  own_edit,     // an edit of this client, which may not be confirmed yet
};

/// The mesh of a chunk is out of date, or it has none: mesh `source`. The chunk or a neighbour
/// changed, arrived or left. Changes of a chunk are merged until they are drained.
struct ChunkChanged {
  MeshSource source;
  ChangeCause cause = ChangeCause::terrain;
};

/// A chunk that was reported by ChunkChanged is not shown any more: remove its mesh.
struct ChunkRemoved {
  ChunkCoord at;
};

/// The server cannot send this chunk. Edits there are refused.
struct ChunkMissing {
  ChunkCoord at;
};

/// The server ordered an edit of this client. If the server crashes before EditDurable, the client
/// offers the edit again, and EditRejected may follow.
struct EditConfirmed {
  EditNumber edit = 0;
  Sequence sequence = 0;  // its place in the log of the world
};

/// The server rejected an edit of this client. It is not shown any more.
struct EditRejected {
  EditNumber edit = 0;
  /// The name of the reason in docs/protocol.md, such as "not_permitted".
  std::string reason;
  /// Words for the player.
  std::string text;
};

/// An edit of this client is on the disk of the server.
struct EditDurable {
  EditNumber edit = 0;
};

/// The server resolved an edit of this client, but its answer was lost with a connection. The
/// chunks show whether it was applied.
struct EditUnseen {
  EditNumber edit = 0;
};

/// An edit of others changed chunks of the view.
struct OthersEdit {
  AuthorId author = 0;  // 0: the server
  Sequence sequence = 0;
  /// The chunks to mesh again because of it, which ChunkChanged reports, too.
  std::vector<ChunkCoord> chunks;
};

/// A line of the chat.
struct ChatReceived {
  enum class From : std::uint8_t {
    player,
    server,              // the host
    message_of_the_day,  // for one who joins
    refused,             // why a line of this client was not passed on
    visit,               // a player has joined or left
    other,               // of a newer server
  };
  From from = From::player;
  std::string name;  // of a player; otherwise empty
  std::string text;
  TimeUs utc_us = 0;  // when the server took the line
};

/// A command has ended.
struct CommandDone {
  bool is_ok = false;
  /// True: the connection ended before the answer was complete, and the command may have been
  /// carried out.
  bool is_answer_lost = false;
  std::vector<std::string> lines;
};

/// WorldClient::materials() has more rows, or rows with other shapes. Chunks with them are reported
/// again.
struct MaterialsChanged {};

/// Players joined, left, or changed name or role: WorldClient::players() differs. Poses are not
/// reported.
struct PlayersChanged {};

/// Something is not as the options want it, and the client goes on: the cache cannot be written, or
/// the key of a server cannot be kept.
struct ClientWarning {
  std::string text;
};

using WorldEvent =
    std::variant<WorldOpened, ConnectionLost, ChunkChanged, ChunkRemoved, ChunkMissing,
                 EditConfirmed, EditRejected, EditDurable, EditUnseen, OthersEdit, ChatReceived,
                 CommandDone, MaterialsChanged, PlayersChanged, ClientWarning>;

}  // namespace runstone
