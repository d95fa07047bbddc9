// DrawChild: draws pictures for a program that has no OpenGL. It starts `runstone-client --draw` as
// a child process, sends it chunks and has them drawn into PNG files. It is a process of its own
// because server and client never include each other, and because a graphics driver that hangs or
// crashes must not end a server.
//
//   auto child = DrawChild::start({});  // or {.program = "/path/to/runstone-client"}
//   if (!child) return error(child.error());  // one line, names the program
//   child->world(edge, materials);  // first, once
//   for (...) child->chunk(key, *voxels);  // a chunk that is not sent is empty
//   child->draw(oblique_camera(box, size), size, "before.png");  // returns with the file
//   child->chunk(key, *other); child->draw(camera, size, "after.png");
//   child->finish();  // without it the destructor kills the child
//
// Every call returns an error as one line of text. An invalid size, camera or file leaves the child
// running, so that the next picture may succeed. After any other error there is no child, and every
// later call returns that error at once. Thread: one at a time. A call blocks until the child has
// done its work, at most `answer_limit`, so the world strand of a server never makes one. The
// sockets between the processes buffer about 200 KB.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
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
  /// Path of runstone-client. If it is empty, the variable RUNSTONE_CLIENT names it, otherwise it
  /// is `runstone-client` in the folder of the running program.
  std::string program;
  /// The child is stopped if it takes longer to answer, or to read what it is sent.
  std::chrono::milliseconds answer_limit{std::chrono::minutes(2)};
  /// The child is stopped soon after this returns false. Empty: it always goes on.
  std::function<bool()> should_continue = {};
};

class DrawChild {
 public:
  template <class T>
  using Outcome = Result<T, std::string>;

  /// Starts the program and waits until it has OpenGL. The child inherits standard error, but no
  /// other socket or file.
  static Outcome<DrawChild> start(const DrawChildOptions& options);
  DrawChild(DrawChild&& other) noexcept;
  DrawChild& operator=(DrawChild&& other) noexcept;
  /// Kills the child if it runs, and waits for its end.
  ~DrawChild();

  /// Returns the child's OpenGL context: "EGL surfaceless" or "OSMesa".
  const std::string& renderer() const { return renderer_; }

  /// Sends the edge of a chunk in voxels and the materials. Call it once, before all other orders.
  Outcome<void> world(std::int32_t edge, const MaterialTable& materials);
  /// Sets the voxels of a chunk, which must be a cube of the world's edge. Cost: O(runs).
  Outcome<void> chunk(const ChunkKey& key, const RunChunk& voxels);
  /// Makes the chunk empty.
  Outcome<void> forget(const ChunkKey& key);
  /// Draws a picture and returns when the file is written. `file`: UTF-8, relative to the working
  /// folder.
  Outcome<PictureDrawn> draw(const DrawCamera& camera, PictureSize size, const std::string& file);
  /// Ends the orders and waits until the child has exited.
  Outcome<void> finish();

 private:
  DrawChild(std::string program, int pid, int socket, const DrawChildOptions& options);
  Outcome<void> send();
  Outcome<DrawAnswer> await_answer();
  Outcome<void> wait_for(short events);
  Outcome<bool> receive();
  Unexpected<std::string> lost(const std::string& why);
  std::string reap();
  void close_and_kill();

  std::string program_, renderer_;
  int pid_ = -1;     // -1: no child
  int socket_ = -1;  // both of the child's standard streams
  std::chrono::milliseconds answer_limit_;
  std::function<bool()> should_continue_;
  Bytes orders_;        // not sent yet
  std::string lines_;   // received, not parsed yet
  std::string broken_;  // the error that every call returns; empty while there is a child
};

}  // namespace runstone
