#include "results/sinks/replay.hpp"

#include "results/messages/message_file.hpp"

namespace whirl::results {
namespace {

void pour(MessageReader& reader, const std::vector<Sink*>& sinks, Replayed& done) {
  for (;;) {
    const auto next = reader.next();
    if (!next) {
      done.damage = next.error();
      return;
    }
    const io::Reader& message = reader.message();
    switch (next.value()) {
      case MessageReader::Next::end:
        return;
      case MessageReader::Next::row:
        ++done.rows;
        done.end_ns = message.header().t_ns;
        for (Sink* sink : sinks) sink->on_row(message.header().t_ns, reader.row());
        break;
      case MessageReader::Next::message:
        for (Sink* sink : sinks) sink->on_message(message);
        break;
    }
  }
}

// Of a run that was cut off nobody wrote down how many rows there are.
Result<std::uint64_t> count_rows(const std::string& messages) {
  auto reader = MessageReader::open(messages);
  if (!reader) return reader.error();
  Replayed done;
  pour(reader.value(), {}, done);
  return done.rows;
}

}  // namespace

Result<Replayed> replay(const std::string& messages, const std::string& folder,
                        const std::vector<SinkType>& types, const std::vector<Sink*>& others,
                        Damaged damaged) {
  auto reader = MessageReader::open(messages);
  if (!reader) return reader.error();
  Replayed done;
  const std::optional<std::uint64_t> stated = reader.value().rows();
  const auto rows = stated ? Result<std::uint64_t>(*stated) : count_rows(messages);
  if (!rows) return rows.error();
  std::vector<std::unique_ptr<Sink>> made;
  std::vector<Sink*> sinks = others;
  for (const SinkType& type : types) {
    made.push_back(type.make({reader.value().head(), folder, rows.value()}));
    sinks.push_back(made.back().get());
  }
  pour(reader.value(), sinks, done);
  done.whole = stated.has_value() && !done.damage;
  if (done.damage && damaged == Damaged::drop) return done;
  for (Sink* sink : sinks) {
    for (Error& lost : sink->finish()) done.lost.push_back(std::move(lost));
  }
  return done;
}

}  // namespace whirl::results
