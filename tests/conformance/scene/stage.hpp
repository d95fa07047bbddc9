// Stage: a scene's server. It accepts the connections of the client under test, plays a correct
// server where the scene says nothing else, and remembers what the client did. A client that breaks
// a rule of the protocol fails the scene, whatever the scene is about. Thread: one.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/tls/tls_context.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/conformance/net/listening_socket.hpp"
#include "tests/conformance/net/player_connection.hpp"
#include "tests/conformance/scene/client_program.hpp"
#include "tests/conformance/scene/scene_world.hpp"

namespace runstone::conformance {

struct StageOptions {
  std::vector<std::string> command;  // of the client
  bool is_encrypted = true;
  int patience_ms = 10'000;  // how long the client may take for each step
  int errors = -1;           // descriptor of the client's standard error; -1: that of this process
};

/// The client has lost the mark of the scene.
struct SceneFailed {
  std::string why;
};
/// The client does not do what the scene is about, and need not.
struct SceneUntried {
  std::string why;
};

/// What a server says in Welcome and SessionAccepted where scenes differ.
struct JoinSetup {
  ChunkEncoding encoding = ChunkEncoding::raw;
  std::uint64_t features = 0;  // in force if the client offers them
  ClientSequence resolved = 0;
  /// Changes a welcome before it is signed.
  std::function<void(Welcome&)> change;
  /// Signs the welcome with this key. nullopt: with the key of the world.
  std::optional<KeySeed> signed_by;
  /// Signs the welcome for this connection. nullopt: for the connection that it is sent on.
  std::optional<ChannelBinding> signed_for;
  /// Called between Welcome and SessionAccepted.
  std::function<void()> before_accepted;
};

class Stage {
 public:
  static constexpr AuthorId kAuthor = 2;  // of the client
  static constexpr OperationId kOther{3, 0x77, 1};

  explicit Stage(StageOptions options);

  SceneWorld& world() { return world_; }
  PlayerConnection& player() { return *player_; }

  // The steps of a session. Each throws SceneFailed with the step that did not come.

  /// Waits for a connection of the client, which is started if it does not run, and for its Hello.
  void connect();
  /// Sends Welcome.
  void welcome(const JoinSetup& setup = {});
  /// Waits for ClientAuth, checks it and sends SessionAccepted.
  void accept(const JoinSetup& setup = {});
  /// Does all of this, and waits for the first view.
  void join(const JoinSetup& setup = {});
  /// Closes the connection at once. The next connect() waits for another one.
  void cut();

  // What the client does.

  const Hello& hello() const { return *hello_; }
  /// Returns true once the client has answered the welcome.
  bool has_proof() const { return auth_.has_value(); }
  bool has_view() const { return view_.has_value(); }
  const View& view() const { return *view_; }
  /// Returns true if the chunk is in the view as the server cuts it.
  bool sees(ChunkCoord at) const;
  std::vector<ChunkCoord> seen() const;
  std::vector<EditRequest> edits;             // taken by the scene
  std::vector<ChunkCoord> requests;           // of ChunkRequest, since the scene cleared it
  std::vector<CachedChunk> claims;            // since the connection began
  std::vector<std::string> lines;             // of the program, that are no answers
  std::uint64_t pings = 0, acknowledged = 0;  // since the connection began
  std::optional<Goodbye> goodbye;             // of the client, on this connection
  bool answers_views = true, answers_requests = true;

  // Sending.

  /// Sends what a server answers for these chunks: snapshots, uniform chunks and missing ones.
  void send_chunks(const std::vector<ChunkCoord>& chunks);
  /// Answers the whole view and says that it is complete.
  void answer_view();
  /// Orders an edit of somebody else and sends its commit.
  OrderedEdit commit(const EditDescriptor& edit);
  /// Orders an edit of the client and sends its commit.
  OrderedEdit commit(const EditRequest& request);
  OperationId operation_of(const EditRequest& request) const;
  /// Sends a line to the program.
  void tell(const std::string& line);

  // Waiting.

  /// Handles what comes until `is_done` returns true. Throws SceneFailed with `what` if it does not
  /// in time, if the client breaks a rule, or if the program ends.
  void wait_until(const std::function<bool()>& is_done, const std::string& what);
  /// Handles what comes for so long.
  void wait_ms(int ms);
  /// Waits for a line that begins with `words`, and removes it and what came before it. Returns it.
  std::string wait_line(const std::string& words);
  /// Waits until the client has sent an edit, and takes it.
  EditRequest wait_edit(const std::string& what);
  /// Waits until the client requests the chunk.
  void wait_request(ChunkCoord at, const std::string& what);
  /// Waits until the client ends the connection, because of `what`.
  void wait_end(const std::string& what);
  /// Waits until the client shows exactly the voxels of the world in its view.
  void wait_same_voxels(const std::string& what);
  /// Fails if the client shows a chunk with other voxels than the world, or outside of its view.
  void check_no_other_voxels(const std::string& what);
  /// Returns the digests of the chunks that the client shows.
  std::map<ChunkCoord, Digest> shown();

 private:
  bool pump();
  void handle(Message message);
  void handle_view(const View& view);
  std::string difference(const std::map<ChunkCoord, Digest>& chunks);
  std::chrono::steady_clock::time_point deadline() const;

  const StageOptions options_;
  const KeyPair keys_;
  std::optional<TlsContext> tls_;
  ListeningSocket listening_;
  SceneWorld world_;
  std::unique_ptr<ClientProgram> program_;
  std::unique_ptr<PlayerConnection> player_;
  bool may_end_ = false;  // the program was told to quit
  SessionStage stage_ = SessionStage::greeting;
  std::uint64_t features_ = 0;  // in force
  ChunkEncoding encoding_ = ChunkEncoding::raw;
  std::optional<Hello> hello_;
  std::optional<Welcome> welcome_;
  std::optional<ClientAuth> auth_;
  std::optional<View> view_;
  std::set<ChunkCoord> sent_;  // of the view
  ClientSequence last_edit_ = 0;
};

}  // namespace runstone::conformance
