// The minimum client of docs/protocol.md, with the codec of the library, under test by
// runstone-conformance. It can have a fault on purpose, so that a test knows that the judge finds
// it. It also compares digests, which a minimum client need not do.
//   conformance-minimum-client [--fault NAME] ADDRESS KEY tls|plain
// Faults:
//   digest      ignores digest checks
//   malformed   ignores messages that are malformed, and goes on
//   signature   does not check the signature of the server
//   versions    applies each commit, whatever the version of the chunk
//   pending     forgets edits without an answer when the connection is lost
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/core/hex.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

using namespace runstone;

namespace {

using Clock = std::chrono::steady_clock;

struct Setup {
  std::string fault;
  std::uint16_t port = 0;
  PublicKey server_key{};
  bool is_plain = false;
};

/// A connection: socket, TLS and frames.
class Wire {
 public:
  Wire(std::uint16_t port, bool is_plain)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)),
        source_(socket_),
        is_plain_(is_plain) {
    sockaddr_in there{};
    there.sin_family = AF_INET;
    there.sin_port = htons(port);
    there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_ended_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&there), sizeof there) != 0;
    if (!is_plain_) tls_.emplace(TlsChannel::connect(TlsContext::client(), source_, "127.0.0.1"));
  }
  ~Wire() { ::close(socket_); }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;

  int socket() const { return socket_; }
  bool is_ended() const { return is_ended_; }
  void end() { is_ended_ = true; }
  bool continue_opening() {
    if (is_open_ || is_plain_) return is_open_ = true;
    const auto status = tls_->handshake();
    flush();
    if (status == TlsChannel::Status::failed || source_.is_at_end()) is_ended_ = true;
    return is_open_ = status == TlsChannel::Status::done;
  }
  std::optional<ChannelBinding> binding() const {
    return is_plain_ ? std::nullopt : std::optional(tls_->binding());
  }
  void send(const Message& message) {
    Bytes bytes;
    frames_.append(encode_message(message), bytes);
    if (is_plain_) return send_all(bytes);
    if (tls_->write(bytes)) flush();
  }
  Bytes read() {
    Bytes buffer(65'536);
    std::size_t got = 0;
    if (is_plain_) {
      got = source_.receive(buffer);
    } else if (tls_->read(buffer, got) == TlsChannel::Status::ended) {
      is_ended_ = true;
    }
    if (source_.is_at_end() || source_.error()) is_ended_ = true;
    buffer.resize(got);
    return buffer;
  }

 private:
  void flush() { send_all(std::exchange(tls_->output(), {})); }
  void send_all(ByteView bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return end();
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
  }

  int socket_;
  SocketSource source_;
  const bool is_plain_;
  std::optional<TlsChannel> tls_;
  FrameWriter frames_;
  bool is_open_ = false, is_ended_ = false;
};

class MinimumClient {
 public:
  explicit MinimumClient(Setup setup) : setup_(std::move(setup)) {
    KeySeed seed;
    seed.fill(0x21);
    keys_ = key_pair_of(seed);
  }

  /// Does what has to be done now. Waits for some milliseconds if there is nothing.
  void step() {
    if (!wire_ && !is_final_ && Clock::now() >= connect_at_) connect();
    pollfd ready[] = {{STDIN_FILENO, POLLIN, 0}, {wire_ ? wire_->socket() : -1, POLLIN, 0}};
    ::poll(ready, 2, 10);
    if (ready[0].revents != 0) read_lines();
    if (!wire_ || !wire_->continue_opening()) return lose_if_ended();
    if (!has_greeted_) greet();
    const Bytes bytes = wire_->read();
    if (!bytes.empty()) {
      const auto fed = reader_->feed(
          bytes, [this](MessageKind kind, ByteView body) { return take(kind, body); });
      if (!fed && !is_over_) end_with(GoodbyeReason::malformed_frame, fed.error().what);
    }
    if (is_open_ && Clock::now() >= ping_at_) {
      wire_->send(Ping{1});
      ping_at_ = Clock::now() + std::chrono::milliseconds(500);
    }
    lose_if_ended();
  }

 private:
  bool has_fault(const char* name) const { return setup_.fault == name; }

  void connect() {
    wire_.emplace(setup_.port, setup_.is_plain);
    reader_.emplace(Sender::server);
    has_greeted_ = is_open_ = is_over_ = false;
    text_.clear();
  }
  void greet() {
    has_greeted_ = true;
    hello_ = {};
    hello_.key = keys_.public_key;
    hello_.instance = 0x4d494e;
    hello_.nonce = {static_cast<std::uint8_t>(++connections_), 9};
    hello_.name = "minimum";
    hello_.encodings = 1;
    wire_->send(hello_);
  }
  void lose_if_ended() {
    if (!wire_ || !wire_->is_ended()) return;
    std::printf("lost %s %s\n", is_final_ ? "final" : "again", text_.c_str());
    wire_.reset();
    connect_at_ = Clock::now() + std::chrono::milliseconds(50);
    if (has_fault("pending")) pending_.clear();
    waiting_.clear();
    if (!is_over_) chunks_.clear();
  }
  /// Ends the session because the server broke a rule.
  void end_with(GoodbyeReason reason, const char* text) {
    wire_->send(Goodbye{reason, text});
    wire_->end();
    is_over_ = true;
    text_ = text;
  }

  Result<void> take(MessageKind kind, ByteView body) {
    if (is_over_) return {};
    auto message = decode_message(Sender::server, kind, body, is_welcome_ ? edge_ : 0);
    if (!message) {
      if (!has_fault("malformed")) end_with(GoodbyeReason::malformed_message, message.error().what);
      return {};
    }
    const auto stage = !has_welcome() ? SessionStage::greeting
                       : is_open_     ? SessionStage::open
                                      : SessionStage::authenticating;
    if (const auto refusal = refusal_of(info_of(*message), Sender::server, stage, 0)) {
      if (!has_fault("malformed")) end_with(refusal->reason, refusal->text);
      return {};
    }
    receive(*std::move(message));
    return {};
  }
  bool has_welcome() const { return is_welcome_ && welcome_of_ == connections_; }

  void receive(Message message) {
    if (const auto* welcome = std::get_if<Welcome>(&message)) answer(*welcome);
    if (const auto* accepted = std::get_if<SessionAccepted>(&message)) open(*accepted);
    if (const auto* chunks = std::get_if<Chunks>(&message)) {
      for (const ChunkAnswer& answer : chunks->chunks) {
        if (const auto* snapshot = std::get_if<ChunkSnapshot>(&answer))
          store(snapshot->key.at, snapshot->chunk);
      }
    }
    if (const auto* uniform = std::get_if<UniformChunks>(&message)) {
      for (const UniformChunk& each : uniform->chunks) {
        if (!view_.contains(each.key.at)) continue;
        store(each.key.at, {uniform_chunk(Extent::cube(edge_), each.material), each.version, {}});
      }
    }
    if (const auto* missing = std::get_if<ChunkUnavailable>(&message)) {
      for (const ChunkKey& key : missing->keys) chunks_.erase(key.at);
    }
    if (const auto* commit = std::get_if<Commit>(&message)) {
      for (const OrderedEdit& edit : commit->edits) take(edit, commit->epoch);
    }
    if (const auto* reject = std::get_if<Reject>(&message)) {
      if (pending_.erase(reject->client_seq) > 0 &&
          reject->reason != RejectReason::already_resolved)
        std::printf("rejected %s\n", to_string(reject->reason));
    }
    if (const auto* check = std::get_if<DigestCheck>(&message)) compare(*check);
    if (const auto* goodbye = std::get_if<Goodbye>(&message)) {
      text_ = goodbye->text;
      is_final_ = goodbye->reason == GoodbyeReason::not_admitted ||
                  goodbye->reason == GoodbyeReason::name_refused;
      wire_->end();
      is_over_ = true;
    }
  }

  void answer(const Welcome& welcome) {
    if (welcome.protocol != kProtocolVersion)
      return end_with(GoodbyeReason::wrong_protocol, "another protocol");
    const Bytes transcript = server_transcript(hello_, welcome, wire_->binding());
    const bool is_proved = welcome.server_key == setup_.server_key &&
                           verify(welcome.server_key, transcript, welcome.signature);
    if (!is_proved && !has_fault("signature"))
      return end_with(GoodbyeReason::not_authenticated, "the signature is wrong");
    if (welcome.features != 0)
      return end_with(GoodbyeReason::malformed_message, "a feature was not offered");
    is_welcome_ = true;
    welcome_of_ = connections_;
    edge_ = welcome.chunk_edge;
    radius_ = welcome.view_radius_max;
    if (connections_ == 1) place_ = welcome.spawn;
    wire_->send(ClientAuth{sign(keys_, client_transcript(hello_, welcome, wire_->binding())), {}});
  }
  void open(const SessionAccepted& accepted) {
    is_open_ = true;
    author_ = accepted.author;
    std::puts("open");
    chunks_.clear();
    view_.number = 0;
    look();
    for (const auto& [seq, edit] : pending_) wire_->send(EditRequest{seq, 0, edit});
  }
  void look() {
    const auto at = [](double v) { return static_cast<std::int32_t>(std::floor(v)); };
    ++view_.number;
    view_.centre = chunk_of({at(place_.x), at(place_.y), at(place_.z)}, edge_);
    view_.radius_h = view_.radius_v = radius_;
    std::erase_if(chunks_, [this](const auto& each) { return !view_.contains(each.first); });
    wire_->send(view_);
  }

  void store(ChunkCoord at, Chunk chunk) {
    if (!view_.contains(at)) return;
    const auto old = chunks_.find(at);
    if (old != chunks_.end() && chunk.version < old->second.version) return;
    chunk.digest = digest_of(chunk.voxels);
    chunks_[at] = std::move(chunk);
    for (const auto& [edit, previous] : std::exchange(waiting_[at], {}))
      apply(at, edit, previous, epoch_);
  }
  void take(const OrderedEdit& edit, Epoch epoch) {
    epoch_ = epoch;
    const auto touched = touched_chunks(edit.edit, edge_);
    for (std::size_t i = 0; i < touched.size(); ++i) {
      if (!view_.contains(touched[i])) continue;
      if (chunks_.contains(touched[i])) {
        apply(touched[i], edit, edit.previous[i], epoch);
      } else {
        waiting_[touched[i]].emplace_back(edit, edit.previous[i]);
      }
    }
    if (edit.op.author == author_ && edit.op.instance == hello_.instance &&
        pending_.erase(edit.op.seq) > 0) {
      std::printf("applied %llu\n", static_cast<unsigned long long>(edit.seq));
    }
  }
  void apply(ChunkCoord at, const OrderedEdit& edit, Sequence previous, Epoch epoch) {
    Chunk& chunk = chunks_.at(at);
    if (!has_fault("versions")) {
      if (chunk.version.seq >= edit.seq) return;
      if (chunk.version.seq != previous) {
        waiting_[at].emplace_back(edit, previous);
        return wire_->send(ChunkRequest{{{0, at}}});
      }
    }
    apply_stack(chunk.voxels, chunk.digest, origin_of(at, edge_), {&edit.edit, 1}, scratch_);
    chunk.version = {epoch, edit.seq};
  }
  void compare(const DigestCheck& check) {
    if (has_fault("digest") || !is_open_) return;
    for (const DigestCheckEntry& entry : check.entries) {
      const auto found = chunks_.find(entry.key.at);
      if (found == chunks_.end()) continue;
      const bool is_behind = found->second.version < entry.version &&
                             std::exchange(behind_[entry.key.at], entry.version) == entry.version;
      const bool differs =
          found->second.version == entry.version && found->second.digest != entry.digest;
      if (is_behind || differs) wire_->send(ChunkRequest{{entry.key}});
    }
  }

  void read_lines() {
    char buffer[4096];
    const ssize_t got = ::read(STDIN_FILENO, buffer, sizeof buffer);
    if (got <= 0) std::exit(0);
    input_.append(buffer, static_cast<std::size_t>(got));
    for (std::size_t end = input_.find('\n'); end != std::string::npos; end = input_.find('\n')) {
      obey(input_.substr(0, end));
      input_.erase(0, end + 1);
    }
  }
  void obey(const std::string& line) {
    std::istringstream words(line);
    std::string verb, digits;
    words >> verb;
    if (verb == "digest") {
      for (const auto& [at, chunk] : chunks_) {
        std::printf("chunk %d %d %d %016llx %016llx\n", at.x, at.y, at.z,
                    static_cast<unsigned long long>(chunk.digest.lane[0]),
                    static_cast<unsigned long long>(chunk.digest.lane[1]));
      }
      std::puts("done");
    } else if (verb == "edit") {
      words >> digits;
      Bytes bytes(digits.size() / 2);
      if (!read_hex(digits, bytes)) return;
      const auto edit = decode_descriptor(bytes);
      if (!edit) return;
      pending_[++edits_] = *edit;
      if (is_open_) wire_->send(EditRequest{edits_, 0, *edit});
    } else if (verb == "move") {
      words >> place_.x >> place_.y >> place_.z;
      if (is_open_) look();
    } else if (verb == "quit") {
      if (wire_ && is_open_) wire_->send(Goodbye{});
      std::exit(0);
    }
  }

  const Setup setup_;
  KeyPair keys_;
  std::optional<Wire> wire_;
  std::optional<FrameReader> reader_;
  Hello hello_;
  unsigned connections_ = 0, welcome_of_ = 0;
  bool has_greeted_ = false, is_welcome_ = false, is_open_ = false, is_final_ = false;
  bool is_over_ = false;  // the session has ended, and its rest is not read
  Clock::time_point connect_at_, ping_at_;
  std::uint16_t edge_ = 16;
  std::uint8_t radius_ = 0;
  AuthorId author_ = 0;
  Epoch epoch_ = 0;
  View view_;
  WorldPos place_;
  std::map<ChunkCoord, Chunk> chunks_;
  std::map<ChunkCoord, std::vector<std::pair<OrderedEdit, Sequence>>> waiting_;
  std::map<ChunkCoord, Version> behind_;  // of the last check
  std::map<ClientSequence, EditDescriptor> pending_;
  ClientSequence edits_ = 0;
  ApplyScratch scratch_;
  std::string input_, text_;
};

}  // namespace

int main(int argc, char** argv) {
  Setup setup;
  int at = 1;
  if (argc > 2 && std::string(argv[1]) == "--fault") {
    setup.fault = argv[2];
    at = 3;
  }
  if (argc != at + 3) return 2;
  const std::string address = argv[at];
  setup.port = static_cast<std::uint16_t>(std::atoi(address.c_str() + address.rfind(':') + 1));
  if (!read_hex(argv[at + 1], setup.server_key)) return 2;
  setup.is_plain = std::string(argv[at + 2]) == "plain";
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  MinimumClient client(setup);
  for (;;) client.step();
}
