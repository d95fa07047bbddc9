#include "tests/conformance/scene/scene.hpp"

#include "protocol/codec/chunk_entries.hpp"

namespace runstone::conformance {
namespace {

void play_goodbye(Stage& stage) {
  stage.join();
  stage.wait_line("open");
  stage.player().send(Message(Goodbye{GoodbyeReason::closing, "the kit closes, 4711"}));
  const std::string line = stage.wait_line("lost again");
  if (line.find("the kit closes, 4711") == std::string::npos)
    throw SceneFailed{"the text of the goodbye is missing in \"" + line + "\""};
  stage.join();
  stage.wait_same_voxels("after it has joined again");
}

void play_final_goodbye(Stage& stage) {
  stage.join();
  stage.wait_line("open");
  stage.player().send(Message(Goodbye{GoodbyeReason::not_admitted, "you are banned, 4712"}));
  const std::string line = stage.wait_line("lost final");
  if (line.find("you are banned, 4712") == std::string::npos)
    throw SceneFailed{"the text of the goodbye is missing in \"" + line + "\""};
}

void play_cut_frame(Stage& stage) {
  stage.answers_views = false;
  stage.join();
  stage.answers_views = true;
  // The connection ends in the middle of a snapshot.
  const ChunkEntry entry =
      encode_snapshot({0, {0, 0, 0}}, stage.world().chunk({0, 0, 0}), ChunkEncoding::raw);
  const EncodedMessage message = join_entries(stage.view().number, {&entry, 1});
  const FrameHeader header = stage.player().next_header(message.kind, message.bytes->size());
  Bytes bytes(header.begin(), header.end());
  bytes.insert(bytes.end(), message.bytes->begin(),
               message.bytes->begin() + static_cast<std::ptrdiff_t>(message.bytes->size() / 2));
  stage.player().send_bytes(bytes);
  stage.cut();
  stage.wait_line("lost again");
  stage.check_no_other_voxels("after a frame that was cut");
  stage.join();
  stage.wait_same_voxels("after it has joined again");
}

void play_ping(Stage& stage) {
  stage.join();
  stage.wait_until([&] { return stage.pings > 0; }, "no Ping");
}

void play_quit(Stage& stage) {
  stage.join();
  stage.wait_line("open");
  stage.tell("quit");
  stage.wait_end("the line \"quit\"");
}

}  // namespace

std::vector<Scene> end_scenes() {
  using enum Part;
  return {
      {"goodbye", "Players, clocks, the end", minimum,
       "shows the text of a goodbye and joins again", play_goodbye},
      {"final-goodbye", "Players, clocks, the end", minimum,
       "shows the text of a goodbye that is final", play_final_goodbye},
      {"cut-frame", "Frames", minimum, "shows nothing of a frame that was cut, and joins again",
       play_cut_frame},
      {"ping", "Players, clocks, the end", minimum, "sends pings", play_ping},
      {"quit", "Players, clocks, the end", minimum, "ends its session when it is told to",
       play_quit},
  };
}

}  // namespace runstone::conformance
