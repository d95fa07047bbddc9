#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {
namespace {

KeySeed another_seed() {
  KeySeed seed;
  seed.fill(0x52);
  return seed;
}

void play_join(Stage& stage) {
  stage.join();
  stage.wait_line("open");
}

void play_early_messages(Stage& stage) {
  JoinSetup setup;
  setup.before_accepted = [&stage] {
    PlayerList list;
    list.players.push_back({Stage::kAuthor, "builder", stage.hello().key, ""});
    stage.player().send(Message(list));
    DigestCheck check;
    check.entries.push_back({{0, {0, 0, 0}}, {}, stage.world().chunk({0, 0, 0}).digest});
    stage.player().send(Message(check));
  };
  stage.join(setup);
  stage.wait_same_voxels("after messages before SessionAccepted");
}

/// The client must not answer a welcome with a proof of its key.
void expect_refusal(Stage& stage, const JoinSetup& setup, const std::string& what) {
  stage.welcome(setup);
  const auto is_ended = [&] { return stage.goodbye || stage.player().is_ended(); };
  stage.wait_until([&] { return is_ended() || stage.has_proof(); },
                   "the client does not end the session after " + what);
  if (stage.has_proof()) throw SceneFailed{"the client sends ClientAuth after " + what};
}
void refuses_welcome(Stage& stage, const JoinSetup& setup, const std::string& what) {
  stage.connect();
  expect_refusal(stage, setup, what);
}

void play_wrong_signature(Stage& stage) {
  JoinSetup setup;
  setup.signed_for = ChannelBinding{1, 2, 3};
  refuses_welcome(stage, setup, "a signature for another connection");
}

void play_spoiled_welcome(Stage& stage) {
  stage.connect();
  JoinSetup setup;
  // The signature is that of another key than the one that the welcome names.
  setup.change = [&](Welcome& out) { out.server_key = key_pair_of(another_seed()).public_key; };
  expect_refusal(stage, setup, "a signature that another key made");
}

void play_other_protocol(Stage& stage) {
  JoinSetup setup;
  setup.change = [](Welcome& welcome) { welcome.protocol = kProtocolVersion + 1; };
  refuses_welcome(stage, setup, "a welcome of another protocol");
}

void play_feature_not_offered(Stage& stage) {
  stage.connect();
  std::uint64_t bit = std::uint64_t{1} << 62;
  while ((stage.hello().features & bit) != 0) bit >>= 1;
  JoinSetup setup;
  setup.change = [bit](Welcome& welcome) { welcome.features |= bit; };
  expect_refusal(stage, setup, "a feature that it did not offer");
}

void play_changed_key(Stage& stage) {
  play_join(stage);
  stage.cut();
  JoinSetup setup;
  setup.signed_by = another_seed();
  refuses_welcome(stage, setup, "another key of a known world");
}

void play_rejoin(Stage& stage) {
  play_join(stage);
  const Hello first = stage.hello();
  stage.wait_same_voxels("before the cut");
  stage.cut();
  stage.world().order(Stage::kOther,
                      {FillSphere{{8, 5, 8}, 4}, {}, SceneWorld::kBrick});  // while it is away
  stage.join();
  const Hello& again = stage.hello();
  if (again.instance != first.instance || again.key != first.key)
    throw SceneFailed{"the second Hello has another key or instance"};
  if (again.nonce == first.nonce) throw SceneFailed{"the second Hello has the same nonce"};
  stage.wait_same_voxels("after the connection was lost");
}

}  // namespace

std::vector<Scene> join_scenes() {
  using enum Part;
  return {
      {"join", "Handshake", minimum, "joins: Hello, ClientAuth with a signature that holds, View",
       play_join},
      {"early-messages", "Frames", minimum, "keeps what arrives before SessionAccepted",
       play_early_messages},
      {"relayed-welcome", "Handshake", minimum, "refuses a signature for another connection",
       play_wrong_signature},
      {"wrong-proof", "Handshake", minimum, "refuses a signature of another key",
       play_spoiled_welcome},
      {"changed-key", "Handshake", minimum, "refuses another key of a world that it knows",
       play_changed_key},
      {"other-protocol", "Handshake", minimum, "refuses a welcome of another protocol",
       play_other_protocol},
      {"feature-not-offered", "Features and evolution", minimum,
       "refuses a welcome with a feature that it did not offer", play_feature_not_offered},
      {"rejoin", "Handshake", minimum, "joins again after a lost connection, and is up to date",
       play_rejoin},
  };
}

}  // namespace runstone::conformance
