#include "tests/conformance/scene/stage.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "common/core/hex.hpp"
#include "protocol/codec/chunk_entries.hpp"

namespace runstone::conformance {
namespace {

constexpr std::uint8_t kRadiusMax = 2;  // of views, in chunks
constexpr int kPollMs = 5;
// Bounds for a client that sends or prints without end.
constexpr int kPumpedMax = 1'000;  // messages and lines that one pump() takes
constexpr std::size_t kLinesMax = 20'000;

KeySeed world_seed() {
  KeySeed seed;
  seed.fill(0x51);
  return seed;
}

std::string text_of(ChunkCoord at) {
  return "(" + std::to_string(at.x) + ", " + std::to_string(at.y) + ", " + std::to_string(at.z) +
         ")";
}

std::optional<std::uint64_t> read_lane(const std::string& digits) {
  std::uint64_t lane = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), lane, 16);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return lane;
}

}  // namespace

Stage::Stage(StageOptions options)
    : options_(std::move(options)), keys_(key_pair_of(world_seed())) {
  if (options_.is_encrypted) tls_ = TlsContext::self_signed_server(world_seed());
}

std::chrono::steady_clock::time_point Stage::deadline() const {
  return std::chrono::steady_clock::now() + std::chrono::milliseconds(options_.patience_ms);
}

void Stage::connect() {
  if (!program_) {
    std::vector<std::string> words = options_.command;
    words.push_back("127.0.0.1:" + std::to_string(listening_.port()));
    words.push_back(to_hex(keys_.public_key));
    words.emplace_back(options_.is_encrypted ? "tls" : "plain");
    program_ = std::make_unique<ClientProgram>(std::move(words), options_.errors);
  }
  player_.reset();
  hello_.reset();
  welcome_.reset();
  auth_.reset();
  view_.reset();
  goodbye.reset();
  sent_.clear();
  claims.clear();
  requests.clear();
  pings = acknowledged = 0;
  features_ = 0;
  stage_ = SessionStage::greeting;
  wait_until(
      [this] {
        if (const auto socket = listening_.accept()) {
          player_ = std::make_unique<PlayerConnection>(*socket, tls_ ? &*tls_ : nullptr,
                                                       std::uint16_t{SceneWorld::kEdge});
        }
        return player_ != nullptr;
      },
      "the client does not connect");
  wait_until([this] { return player_->continue_opening(); }, "the TLS handshake does not end");
  wait_until([this] { return hello_.has_value(); }, "no Hello");
}

void Stage::welcome(const JoinSetup& setup) {
  if ((hello_->encodings & 1U << (static_cast<unsigned>(setup.encoding) - 1)) == 0)
    throw SceneUntried{std::string("the client does not offer ") + name_of(setup.encoding)};
  Welcome out;
  for (std::size_t i = 0; i < out.world_id.size(); ++i)
    out.world_id[i] = static_cast<std::uint8_t>(0x30 + i);
  out.epoch = world_.epoch();
  out.durable = 0;
  out.head = world_.head();
  out.chunk_edge = SceneWorld::kEdge;
  out.heights = {-256, 256};
  out.spawn = {8, 20, 8};
  out.materials = SceneWorld::materials();
  out.server_key = keys_.public_key;
  for (std::size_t i = 0; i < out.challenge.size(); ++i)
    out.challenge[i] = static_cast<std::uint8_t>(hello_->nonce[i] ^ (0x5a + i));
  out.encoding = setup.encoding;
  out.edit_volume_max = 1'000'000;
  out.view_radius_max = kRadiusMax;
  out.features = setup.features & hello_->features;
  if (setup.change) setup.change(out);
  const auto bound = setup.signed_for ? setup.signed_for : player_->binding();
  const KeyPair signer = setup.signed_by ? key_pair_of(*setup.signed_by) : keys_;
  if (setup.signed_by) out.server_key = signer.public_key;
  out.signature = sign(signer, server_transcript(*hello_, out, bound));
  encoding_ = setup.encoding;
  features_ = out.features & hello_->features;
  welcome_ = out;
  stage_ = SessionStage::authenticating;
  player_->send(Message(out));
}

void Stage::accept(const JoinSetup& setup) {
  wait_until([this] { return auth_.has_value(); }, "no ClientAuth");
  const Bytes transcript = client_transcript(*hello_, *welcome_, player_->binding());
  if (!verify(hello_->key, transcript, auth_->signature))
    throw SceneFailed{"the signature in ClientAuth does not hold for the client transcript"};
  if (setup.before_accepted) setup.before_accepted();
  SessionAccepted out;
  out.author = kAuthor;
  out.resolved = setup.resolved;
  stage_ = SessionStage::open;
  player_->send(Message(out));
}

void Stage::join(const JoinSetup& setup) {
  connect();
  welcome(setup);
  accept(setup);
  wait_until([this] { return has_view(); }, "no View");
}

void Stage::cut() { player_->cut(); }

bool Stage::sees(ChunkCoord at) const {
  View cut = *view_;
  cut.radius_h = std::min(cut.radius_h, kRadiusMax);
  cut.radius_v = std::min(cut.radius_v, kRadiusMax);
  return cut.contains(at);
}

std::vector<ChunkCoord> Stage::seen() const {
  std::vector<ChunkCoord> out;
  const ChunkCoord c = view_->centre;
  for (std::int32_t x = c.x - kRadiusMax; x <= c.x + kRadiusMax; ++x) {
    for (std::int32_t y = c.y - kRadiusMax; y <= c.y + kRadiusMax; ++y) {
      for (std::int32_t z = c.z - kRadiusMax; z <= c.z + kRadiusMax; ++z) {
        if (sees({x, y, z})) out.push_back({x, y, z});
      }
    }
  }
  return out;
}

void Stage::send_chunks(const std::vector<ChunkCoord>& chunks) {
  ChunksBuilder builder;
  UniformChunks uniform;
  ChunkUnavailable missing;
  uniform.view = missing.view = view_->number;
  missing.reason = static_cast<UnavailableReason>(9);  // clients accept reasons of later servers
  for (const ChunkCoord at : chunks) {
    sent_.insert(at);
    if (world_.damaged.contains(at)) {
      missing.keys.push_back({0, at});
      continue;
    }
    const Chunk& chunk = world_.chunk(at);
    if (chunk.voxels.is_uniform()) {
      uniform.chunks.push_back({{0, at}, chunk.voxels.runs.material(0), chunk.version});
      continue;
    }
    ChunkEntry entry = encode_snapshot({0, at}, chunk, encoding_);
    if (!builder.fits(entry)) player_->send(builder.take(view_->number));
    builder.add(std::move(entry));
  }
  if (!builder.empty()) player_->send(builder.take(view_->number));
  if (!uniform.chunks.empty()) player_->send(Message(uniform));
  if (!missing.keys.empty()) player_->send(Message(missing));
}

void Stage::answer_view() {
  std::vector<ChunkCoord> chunks;
  for (const ChunkCoord at : seen()) {
    if (!sent_.contains(at)) chunks.push_back(at);
  }
  if (!chunks.empty()) send_chunks(chunks);
  ViewState state;
  state.view = view_->number;
  state.phase = ViewPhase::complete;
  player_->send(Message(state));
}

OperationId Stage::operation_of(const EditRequest& request) const {
  return {kAuthor, hello_->instance, request.client_seq};
}

OrderedEdit Stage::commit(const EditDescriptor& edit) {
  OrderedEdit out = world_.order(kOther, edit);
  player_->send(Message(world_.commit_of(out)));
  return out;
}

OrderedEdit Stage::commit(const EditRequest& request) {
  OrderedEdit out = world_.order(operation_of(request), request.edit);
  player_->send(Message(world_.commit_of(out)));
  return out;
}

void Stage::tell(const std::string& line) {
  may_end_ = line == "quit";
  program_->write_line(line);
}

void Stage::handle_view(const View& view) {
  if (view_ && view.number <= view_->number)
    throw SceneFailed{"the number of a View does not ascend"};
  view_ = view;
  std::erase_if(sent_, [this](ChunkCoord at) { return !sees(at); });
  if (answers_views) answer_view();
}

void Stage::handle(Message message) {
  const MessageInfo& info = info_of(message);
  if (const auto refusal = refusal_of(info, Sender::client, stage_, features_)) {
    throw SceneFailed{std::string("the client sends ") + info.name + ": " + refusal->text};
  }
  if (auto* hello = std::get_if<Hello>(&message)) {
    if (hello->protocol != kProtocolVersion)
      throw SceneFailed{"Hello has protocol " + std::to_string(hello->protocol)};
    hello_ = std::move(*hello);
  } else if (auto* auth = std::get_if<ClientAuth>(&message)) {
    auth_ = std::move(*auth);
  } else if (const auto* wanted = std::get_if<View>(&message)) {
    handle_view(*wanted);
  } else if (const auto* again = std::get_if<ChunkRequest>(&message)) {
    std::vector<ChunkCoord> known;
    for (const ChunkKey& key : again->keys) {
      requests.push_back(key.at);
      if (view_ && sees(key.at) && sent_.contains(key.at)) known.push_back(key.at);
    }
    if (answers_requests && !known.empty()) send_chunks(known);
  } else if (auto* edit = std::get_if<EditRequest>(&message)) {
    edits.push_back(std::move(*edit));
  } else if (const auto* cached = std::get_if<CachedChunks>(&message)) {
    claims.insert(claims.end(), cached->chunks.begin(), cached->chunks.end());
  } else if (const auto* ping = std::get_if<Ping>(&message)) {
    ++pings;
    player_->send(Message(Pong{ping->sent_us, 1'000'000'000 + static_cast<TimeUs>(pings)}));
  } else if (const auto* ack = std::get_if<ReceiveAck>(&message)) {
    if (ack->chunk_bytes < acknowledged || ack->chunk_bytes > player_->chunk_bytes_sent())
      throw SceneFailed{"ReceiveAck has " + std::to_string(ack->chunk_bytes) + " bytes"};
    acknowledged = ack->chunk_bytes;
  } else if (auto* end = std::get_if<Goodbye>(&message)) {
    goodbye = std::move(*end);
  }
}

bool Stage::pump() {
  bool has_moved = false;
  if (player_) {
    const bool is_open = player_->continue_opening();
    for (int taken = 0; is_open && taken < kPumpedMax; ++taken) {
      auto message = player_->next();
      if (!message) break;
      has_moved = true;
      handle(*std::move(message));
    }
    if (!player_->fault().empty()) throw SceneFailed{player_->fault()};
  }
  for (int taken = 0; program_ && taken < kPumpedMax; ++taken) {
    auto line = program_->next();
    if (!line) break;
    has_moved = true;
    if (lines.size() == kLinesMax) throw SceneFailed{"the program prints too many lines"};
    lines.push_back(*std::move(line));
  }
  if (program_ && program_->is_ended() && !may_end_)
    throw SceneFailed{"the program of the client has ended"};
  return has_moved;
}

void Stage::wait_until(const std::function<bool()>& is_done, const std::string& what) {
  const auto end = deadline();
  while (!is_done()) {
    const bool is_late = std::chrono::steady_clock::now() >= end;
    const bool has_moved = pump();
    if (is_late && !is_done()) throw SceneFailed{what};
    if (has_moved) continue;
    pollfd ready[] = {{listening_.descriptor(), POLLIN, 0},
                      {program_ ? program_->descriptor() : -1, POLLIN, 0},
                      {player_ && !player_->is_ended() ? player_->descriptor() : -1, POLLIN, 0}};
    ::poll(ready, 3, kPollMs);
  }
}

void Stage::wait_ms(int ms) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(ms);
  wait_until([&] { return std::chrono::steady_clock::now() >= end; }, "");
}

std::string Stage::wait_line(const std::string& words) {
  const auto find = [&] {
    return std::find_if(lines.begin(), lines.end(),
                        [&](const std::string& line) { return line.starts_with(words); });
  };
  wait_until([&] { return find() != lines.end(); }, "the program does not print \"" + words + "\"");
  const auto found = find();
  std::string out = *found;
  lines.erase(lines.begin(), found + 1);
  return out;
}

EditRequest Stage::wait_edit(const std::string& what) {
  wait_until([this] { return !edits.empty(); }, what);
  EditRequest out = std::move(edits.front());
  edits.erase(edits.begin());
  return out;
}

void Stage::wait_request(ChunkCoord at, const std::string& what) {
  wait_until([&] { return std::find(requests.begin(), requests.end(), at) != requests.end(); },
             "no ChunkRequest of the chunk " + text_of(at) + " " + what);
}

void Stage::wait_end(const std::string& what) {
  wait_until([this] { return goodbye.has_value() || player_->is_ended(); },
             "the client does not end the session after " + what);
}

std::map<ChunkCoord, Digest> Stage::shown() {
  lines.clear();
  tell("digest");
  wait_until([this] { return std::find(lines.begin(), lines.end(), "done") != lines.end(); },
             "the program does not answer \"digest\" with \"done\"");
  std::map<ChunkCoord, Digest> out;
  for (const std::string& line : lines) {
    if (!line.starts_with("chunk ")) continue;
    std::istringstream words(line.substr(6));
    ChunkCoord at;
    std::string first, second;
    words >> at.x >> at.y >> at.z >> first >> second;
    const auto lane_0 = read_lane(first), lane_1 = read_lane(second);
    if (!words || !lane_0 || !lane_1) throw SceneFailed{"the program prints \"" + line + "\""};
    out[at] = Digest{{*lane_0, *lane_1}};
  }
  return out;
}

std::string Stage::difference(const std::map<ChunkCoord, Digest>& chunks) {
  for (const ChunkCoord at : seen()) {
    const auto found = chunks.find(at);
    if (world_.damaged.contains(at)) {
      if (found != chunks.end()) return "the chunk " + text_of(at) + " is shown";
      continue;
    }
    if (found == chunks.end()) return "the chunk " + text_of(at) + " is not shown";
    if (found->second != world_.chunk(at).digest)
      return "the chunk " + text_of(at) + " has other voxels";
  }
  return {};
}

void Stage::wait_same_voxels(const std::string& what) {
  const auto end = deadline();
  for (;;) {
    const std::string why = difference(shown());
    if (why.empty()) return;
    if (std::chrono::steady_clock::now() >= end) throw SceneFailed{what + ": " + why};
    wait_ms(10);
  }
}

void Stage::check_no_other_voxels(const std::string& what) {
  for (const auto& [at, digest] : shown()) {
    if (view_ && !sees(at))
      throw SceneFailed{what + ": the chunk " + text_of(at) + " is shown, outside of the view"};
    if (digest != world_.chunk(at).digest)
      throw SceneFailed{what + ": the chunk " + text_of(at) + " has other voxels"};
  }
}

}  // namespace runstone::conformance
