// KeyframeThread: makes keyframes while a server runs. It follows the log on disk with a reader of its own and hands what it
// makes to the log writer, so the world strand never waits for it. A failure is logged and ends this thread, not the server:
// the log holds all that keyframes say, and the next start tries again.
#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "common/generate/generator.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/store/log_writer.hpp"

namespace runstone {

class KeyframeThread {
 public:
  /// Starts with what is due in the log already. `generator` and `writer` must outlive the object.
  KeyframeThread(std::string folder, const Generator& generator, const KeyframePolicy& policy,
                 LogWriter& writer);
  /// stop().
  ~KeyframeThread();
  KeyframeThread(const KeyframeThread&) = delete;
  KeyframeThread& operator=(const KeyframeThread&) = delete;

  /// The log is on disk up to here. Any thread; does not wait.
  void durable(Sequence seq);
  /// Ends the thread; it waits for one chunk or one slice at most. A keyframe half made is left for the next start.
  /// While the writer still runs, or after it failed. May be called again.
  void stop();

 private:
  void run();
  /// Waits until there is enough that is new to look at. False when it is time to end.
  bool wait_for_work(Sequence seen);
  bool is_stopping() const;
  StoreResult<void> save(KeyframeMaker::Chunks chunks, const std::optional<Keyframe>& keyframe);

  const std::string folder_;
  const Generator& generator_;
  const KeyframePolicy policy_;
  LogWriter& writer_;
  mutable std::mutex mutex_;  // a leaf
  std::condition_variable work_;
  Sequence durable_ = 0;  // guarded, as stopping_
  bool stopping_ = false;
  std::thread thread_;  // starts last
};

}  // namespace runstone
