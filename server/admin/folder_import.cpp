#include "server/admin/folder_import.hpp"

#include <utility>

#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

constexpr TimeUs kFolderReportUs = 2'000'000;
/// The time between two batches in which the log writer may take the file of a player. A tick comes
/// in between.
constexpr TimeUs kFolderPauseUs = 60'000;

}  // namespace

FolderImport::FolderImport(const CommandCall& call, std::shared_ptr<const BuildFolder> folder)
    : call_(call),
      path_(folder->path),
      files_(folder->names.size()),
      others_(folder->others),
      folder_(std::move(folder)),
      report_us_(call.now.steady_us + kFolderReportUs) {}

void FolderImport::tick(const Clocks& now) {
  if (is_over()) return;
  call_.now = now;
  if (!call_.world().order().accepts_edits()) {
    return end("the server stops, its log cannot be written, or another server owns the world");
  }
  if (now.steady_us >= report_us_) {
    report_us_ = now.steady_us + kFolderReportUs;
    call_.report("builds import: " + std::to_string(added_ + known_ + refused_) + " of " +
                 counted(files_, "file"));
  }
  if (stage_ == Stage::between && now.steady_us >= next_batch_us_) read_batch();
  if (stage_ == Stage::waiting) save_next();
}

void FolderImport::read_batch() {
  stage_ = Stage::reading;
  auto batch = std::make_shared<FolderBatch>();
  call_.services.workers.run(
      [batch, folder = folder_, first = batch_.next,
       bytes_max = call_.world().order().library().limits().file_bytes_max,
       should_continue = call_.services.rollback.should_continue()](WorldReader&,
                                                                    const Generator&) {
        *batch = read_build_folder(*folder, first, bytes_max, should_continue);
      },
      [self = shared_from_this(), batch](const std::string& error) {
        self->take_batch(std::move(*batch), error);
      });
}

void FolderImport::take_batch(FolderBatch batch, const std::string& error) {
  if (is_over()) return;
  if (!error.empty()) return end(error);
  batch_ = std::move(batch);
  saved_of_batch_ = 0;
  known_ += batch_.known;
  refused_ += batch_.refusals.size();
  for (std::string& refusal : batch_.refusals) {
    if (refusals_.size() < kRefusalsShown) refusals_.push_back(std::move(refusal));
  }
  save_next();
}

void FolderImport::save_next() {
  if (saved_of_batch_ == batch_.builds.size()) {
    const bool has_written = !batch_.builds.empty();
    batch_.builds.clear();
    if (batch_.next == files_) return end("");
    if (!has_written) return read_batch();
    next_batch_us_ = call_.now.steady_us + kFolderPauseUs;
    stage_ = Stage::between;
    return;
  }
  const BuildFile& file = batch_.builds[saved_of_batch_];
  AddBuild build = file.build;
  if (const auto why =
          call_.world().order().library().refusal(call_.caller.author, build.file_bytes))
    return end(*why);
  if (const auto why = call_.world().cluster().library_refusal()) return end(*why);
  const auto& save = call_.services.actions.save_build_file;
  if (!save) return end("the world cannot be written");
  build.content = call_.world().changes().next_build_content();
  stage_ = Stage::saving;
  const auto done = [self = shared_from_this(), build](const std::string& error) {
    self->saved(build, error);
  };
  if (!save(build.content, file.bytes, done)) stage_ = Stage::waiting;
}

void FolderImport::saved(const AddBuild& build, const std::string& error) {
  if (is_over()) return;  // the next start removes the file
  if (!error.empty()) return end(error);
  const auto added = call_.world().changes().add_build(build, call_.caller.author, call_.now);
  if (!added) return end(added.error());
  last_ = *added;
  ++added_;
  ++saved_of_batch_;
  save_next();
}

std::string FolderImport::summary(const std::string& why) const {
  std::string text =
      "added: " + counted(added_, "build") + " of " + counted(files_, "file") + " in " + path_;
  if (known_ > 0) text += "; left out: " + std::to_string(known_) + " that the library has already";
  if (others_ > 0) text += "; left out: " + std::to_string(others_) + " that are no .rsb files";
  if (!why.empty()) text += "\nended before the end of the folder: " + why;
  if (refused_ > 0) text += "\nrefused: " + counted(refused_, "file");
  for (const std::string& refusal : refusals_) text += "\n  " + refusal;
  if (refused_ > refusals_.size())
    text += "\n  and " + std::to_string(refused_ - refusals_.size()) + " more";
  return text;
}

void FolderImport::end(const std::string& why) {
  if (is_over()) return;
  stage_ = Stage::over;
  batch_ = {};
  // A worker frees the names, which may be a million.
  call_.services.workers.run(
      [folder = std::exchange(folder_, nullptr)](WorldReader&, const Generator&) {},
      [](const std::string&) {});
  const std::string text = summary(why);
  if (why.empty() && refused_ == 0 && last_ != 0) return call_.answer_when_durable(last_, text);
  const bool is_ok = why.empty() && refused_ == 0;
  const auto answer = [call = call_, text, is_ok] { call.reply(CommandAnswer::last(text, is_ok)); };
  if (last_ == 0) return answer();
  call_.services.waiting.push_back(
      {last_,
       answer,
       [call = call_, text] {
         call.refuse(text + "\nnot all of it is on disk: the log cannot be written any more");
       },
       {},
       0,
       false});
}

}  // namespace runstone
