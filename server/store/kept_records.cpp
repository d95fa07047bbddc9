#include "server/store/kept_records.hpp"

#include "server/store/record_checksum.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {

StoreResult<KeptRecords> KeptRecords::open(sql::Database& database) {
  auto all = database.prepare("SELECT seq, record, checksum FROM rights_record ORDER BY seq");
  if (!all) return failed(all.error());
  auto insert =
      database.prepare("INSERT INTO rights_record(seq, record, checksum) VALUES(?1, ?2, ?3)");
  if (!insert) return failed(insert.error());
  return KeptRecords(database.file(), *std::move(all), *std::move(insert));
}

StoreResult<FoldedRows<EditRecord>> KeptRecords::records(std::optional<Cause> cause) {
  const auto take = [&](const sql::Statement& row,
                        std::vector<EditRecord>& rows) -> StoreResult<void> {
    const std::int64_t seq = row.integer(0);
    const ByteView bytes = row.blob(1);
    bool is_sound = static_cast<std::int64_t>(record_checksum(bytes)) == row.integer(2);
    if (is_sound && (!cause || cause_of_record(bytes) == cause)) {
      auto record = decode_record(bytes);
      is_sound =
          record && static_cast<std::int64_t>(record->version.seq) == seq &&
          (rights_change_of(record->edit) != nullptr || given_texture_of(record->edit) != nullptr);
      if (is_sound) rows.push_back(*std::move(record));
    }
    if (is_sound) return {};
    return failure(StoreError{StoreError::Kind::corrupt, file_,
                              "rights_record seq=" + std::to_string(seq),
                              "checksum or encoding is wrong"});
  };
  return read_folded_rows<EditRecord>(all_, 2, take);
}

StoreResult<void> KeptRecords::add(const EditRecord& record, RowFold& fold) {
  const Bytes bytes = encode_record(record);
  const auto checksum = static_cast<std::int64_t>(record_checksum(bytes));
  add_row(fold, checksum);
  return store_result(insert_.bind(1, static_cast<std::int64_t>(record.version.seq))
                          .bind(2, ByteView(bytes))
                          .bind(3, checksum)
                          .run());
}

}  // namespace runstone
