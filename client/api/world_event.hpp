// WorldEvent: an event of a WorldClient. WorldClient::drain() returns the events.
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

/// A world is open: for the first time, again after a lost connection, or another world of the
/// server. WorldClient::world() describes it.
struct WorldOpened {
  /// True if this is another world than the one before. All chunks and edits of the earlier world
  /// are removed.
  bool is_another = false;
  /// True if the key of the server was not known for this world. The player should compare
  /// ClientWorld::server_fingerprint with the fingerprint that the host gives.
  bool is_first_contact = false;
};

/// A connection ended, or could not be made. The chunks and the edits stay.
struct ConnectionLost {
  /// A sentence for the player, without a full stop.
  std::string headline;
  /// The exact reason that the server or the system gave. It may be empty.
  std::string detail;
  /// True if the client does not connect again, because another attempt with the same options is
  /// pointless. For example, the password is wrong.
  bool is_final = false;
  /// True if the world has a password and the options have none.
  bool lacks_password = false;
};

/// The reason why a chunk has to be meshed again.
enum class ChangeCause : std::uint8_t {
  terrain,      // the chunk or a neighbour arrived or left, or materials changed
  others_edit,  // edits of others
  own_edit,     // an edit of this client, which may not be confirmed yet
};

/// The mesh of a chunk is out of date or missing: mesh `source`. The chunk or a neighbour changed,
/// arrived or left. Changes of a chunk are merged until they are drained.
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

/// The server rejected an edit of this client. The edit is not shown any more.
struct EditRejected {
  EditNumber edit = 0;
  /// The name of the reason in docs/protocol.md, such as "not_permitted".
  std::string reason;
  /// The reason in words for the player.
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
  /// The chunks to mesh again because of this edit. ChunkChanged reports them, too.
  std::vector<ChunkCoord> chunks;
};

/// A line of the chat.
struct ChatReceived {
  enum class From : std::uint8_t {
    player,
    server,              // the host
    message_of_the_day,  // for a player who joins
    refused,             // the server rejected a line of this client; `text` is the reason
    visit,               // a player has joined or left
    other,               // a kind of a newer server
  };
  From from = From::player;
  std::string name;  // of a player; otherwise empty
  std::string text;
  TimeUs utc_us = 0;  // when the server took the line
};

/// A command has ended.
struct CommandDone {
  bool is_ok = false;
  /// True if the connection ended before the answer was complete. The command may have been carried
  /// out.
  bool is_answer_lost = false;
  std::vector<std::string> lines;
};

/// WorldClient::materials() has more rows, or rows with other shapes. Chunks with them are reported
/// again.
struct MaterialsChanged {};

/// Players joined, left, or changed their name or role: WorldClient::players() differs. Changes of
/// poses are not reported.
struct PlayersChanged {};

/// An option cannot be honoured, and the client goes on. For example, the cache cannot be written,
/// or the key of a server cannot be kept.
struct ClientWarning {
  std::string text;
};

using WorldEvent =
    std::variant<WorldOpened, ConnectionLost, ChunkChanged, ChunkRemoved, ChunkMissing,
                 EditConfirmed, EditRejected, EditDurable, EditUnseen, OthersEdit, ChatReceived,
                 CommandDone, MaterialsChanged, PlayersChanged, ClientWarning>;

}  // namespace runstone
