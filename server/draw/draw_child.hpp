// DrawChild: pictures for a program that has no OpenGL. It starts `runstone-client --draw` as a child process,
// sends it chunks and has them drawn into PNG files. A child, because server and client never include each
// other, and because a graphics driver that hangs or crashes must not take a server with it.
//
//   auto child = DrawChild::start({});                          // or {.program = "/path/to/runstone-client"}
//   if (!child) return error(child.error());                    // one line, names the program
//   child->world(edge, materials);                              // first, once
//   for (...) child->chunk(key, *voxels);                       // what is not sent counts as empty
//   child->draw(oblique_camera(box, size), size, "before.png"); // returns when the file is there
//   child->chunk(key, *other); child->draw(camera, size, "after.png");
//   child->finish();                                            // or just drop it: the child is killed
//
// Every call returns an error as one line of text. After a picture whose size, place or file will not do the next one may
// succeed; after any other error there is no child any more, and every later call says so at once. One thread at a time; the calls
// block, on the child's work at most `answer_limit` each, so a server's world strand never makes them.
// The pair of sockets in between holds some 200 KB: the child is written to as fast as it reads.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"
#include "protocol/codec/draw_answer.hpp"
#include "protocol/codec/draw_order.hpp"

namespace runstone {

struct DrawChildOptions {
  /// The client's program. Empty: what the environment's RUNSTONE_CLIENT names, else `runstone-client` in the
  /// folder of the running program.
  std::string program;
  /// Longest silence of the child while something is expected of it.
  std::chrono::milliseconds answer_limit{std::chrono::minutes(2)};
};

class DrawChild {
 public:
  template <class T>
  using Outcome = Result<T, std::string>;

  /// Starts the program and waits until it has OpenGL. The child gets our standard error, nothing else of
  /// ours: no socket, no file.
  static Outcome<DrawChild> start(const DrawChildOptions& options);
  DrawChild(DrawChild&& other) noexcept;
  DrawChild& operator=(DrawChild&& other) noexcept;
  /// Kills the child if it runs, and reaps it.
  ~DrawChild();

  /// "EGL surfaceless" or "OSMesa".
  const std::string& renderer() const { return renderer_; }

  /// What the chunks are made of. First, and once. `edge`: voxels a side.
  Outcome<void> world(std::int32_t edge, const MaterialTable& materials);
  /// The chunk looks like this from now on. A cube of the world's edge. Packed and sent: O(runs).
  Outcome<void> chunk(const ChunkKey& key, const RunChunk& voxels);
  Outcome<void> forget(const ChunkKey& key);
  /// Has the picture drawn and written, and returns when it is on the disk. `file`: UTF-8, from our working
  /// folder.
  Outcome<PictureDrawn> draw(const DrawCamera& camera, PictureSize size, const std::string& file);
  /// No more orders: waits until the child has ended by itself.
  Outcome<void> finish();

 private:
  DrawChild(std::string program, int pid, int socket, std::chrono::milliseconds answer_limit);
  Outcome<void> send();
  Outcome<DrawAnswer> await_answer();
  Outcome<void> wait_for(short events);
  Outcome<bool> receive();
  Unexpected<std::string> lost(const std::string& why);
  std::string reap();
  void close_and_kill();

  std::string program_, renderer_;
  int pid_ = -1;     // -1: none, or reaped
  int socket_ = -1;  // both of the child's standard streams
  std::chrono::milliseconds answer_limit_;
  Bytes orders_;        // not sent yet
  std::string lines_;   // received, not taken yet
  std::string broken_;  // why there is no child any more; empty while there is
};

}  // namespace runstone
