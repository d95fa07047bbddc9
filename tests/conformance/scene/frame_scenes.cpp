#include <utility>

#include "tests/conformance/scene/scene.hpp"

namespace runstone::conformance {
namespace {

/// Spoils the frame of a Pong, whose header and body it gets.
using Spoil = void (*)(FrameHeader& header, Bytes& body);

void play_spoiled_frame(Stage& stage, Spoil spoil) {
  stage.join();
  stage.wait_same_voxels("before the frame");
  const EncodedMessage pong = encode_message(Message(Pong{1, 2}));
  Bytes body = *pong.bytes;
  FrameHeader header = stage.player().next_header(pong.kind, body.size());
  spoil(header, body);
  Bytes bytes(header.begin(), header.end());
  bytes.insert(bytes.end(), body.begin(), body.end());
  stage.player().send_bytes(bytes);
  stage.wait_end("a malformed frame");
  stage.check_no_other_voxels("after a malformed frame");
}

Scene spoiled_frame(std::string name, std::string words, Spoil spoil) {
  return {std::move(name), "Frames", Part::minimum, "ends the session after " + std::move(words),
          [spoil](Stage& stage) { play_spoiled_frame(stage, spoil); }};
}

/// Sends a message that never ends: more than the bytes of its class, in fragments.
void play_endless_message(Stage& stage) {
  stage.join();
  stage.wait_same_voxels("before the message");
  for (std::size_t sent = 0; sent <= kServerControlBytesMax; sent += kFragmentBytesMax)
    stage.player().send_unfinished(kKindOf<PlayerPoses>, kFragmentBytesMax);
  stage.wait_end("a message above the limit of its class");
}

}  // namespace

std::vector<Scene> frame_scenes() {
  return {
      spoiled_frame("frame-counter", "a frame with another counter",
                    [](FrameHeader& header, Bytes&) { header[4] ^= 1; }),
      spoiled_frame("frame-flags", "a frame with an unknown flag",
                    [](FrameHeader& header, Bytes&) { header[3] |= 0x80; }),
      spoiled_frame("frame-empty", "a frame without a body",
                    [](FrameHeader& header, Bytes& body) {
                      header[0] = header[1] = 0;
                      body.clear();
                    }),
      spoiled_frame("frame-long", "a frame of more than 16,384 bytes",
                    [](FrameHeader& header, Bytes& body) {
                      header[0] = 1;
                      header[1] = 0x40;
                      body.resize(kFragmentBytesMax + 1);
                    }),
      spoiled_frame("unknown-kind", "a message of an unknown kind",
                    [](FrameHeader& header, Bytes&) { header[2] = 250; }),
      spoiled_frame("kind-of-client", "a message that only a client sends",
                    [](FrameHeader& header, Bytes&) { header[2] = wire_number(kKindOf<Ping>); }),
      {"endless-message", "Frames", Part::minimum,
       "ends the session after a message above the limit of its class", play_endless_message},
  };
}

}  // namespace runstone::conformance
