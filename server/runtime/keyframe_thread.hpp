// KeyframeThread: makes keyframes while a server runs. It reads the log on disk with its own reader
// and queues keyframes for the log writer, so the world strand never waits for it. A failure is
// logged and ends this thread, not the server: keyframes contain nothing that the log does not, and
// the next start tries again.
#pragma once
#include <chrono>
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
  /// Starts the thread, which first makes the keyframes that are due in the log already.
  /// `generator` and `writer` must outlive the object.
  KeyframeThread(std::string place, const Generator& generator, const KeyframePolicy& policy,
                 LogWriter& writer);
  /// Calls stop().
  ~KeyframeThread();
  KeyframeThread(const KeyframeThread&) = delete;
  KeyframeThread& operator=(const KeyframeThread&) = delete;

  /// Reports that the log is on disk up to `seq`. Thread: any. Does not wait.
  void durable(Sequence seq);
  /// Ends the thread. Waits for at most one chunk or one slice. The next start makes a keyframe
  /// that was not finished. Requires that the writer still runs or has failed. It may be called
  /// again.
  void stop();

 private:
  void run();
  /// Waits until the log is on disk up to `seq`. Returns false if the thread must end.
  bool wait_for(Sequence seq);
  bool is_stopping() const;
  /// Rests. Returns false if the thread must end.
  bool rest(std::chrono::nanoseconds time);
  StoreResult<void> save(KeyframeMaker::Chunks chunks, const std::optional<Keyframe>& keyframe);

  const std::string place_;
  const Generator& generator_;
  const KeyframePolicy policy_;
  LogWriter& writer_;
  mutable std::mutex mutex_;  // a leaf
  std::condition_variable work_;
  Sequence durable_ = 0;   // guarded by mutex_
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;     // starts last, because it uses the members above
};

}  // namespace runstone
