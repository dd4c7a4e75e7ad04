#include "lua/binding/replay/journal.hpp"

#include "libcdem/checkpoint/archive.hpp"
#include "lua/binding/objects/pile_object.hpp"

#include <stdexcept>

namespace cdem::script {

namespace {

enum class Tag : std::uint8_t { nil, no, yes, integer, number, text, table, pile };

void write(Writer& a, const Value& value) {
  const auto tag = [&](Tag t) { archive_const(a, t); };
  if (const auto* flag = value.get<bool>()) {
    tag(*flag ? Tag::yes : Tag::no);
  } else if (const auto* integer = value.get<std::int64_t>()) {
    tag(Tag::integer);
    archive_const(a, *integer);
  } else if (const auto* number = value.get<double>()) {
    tag(Tag::number);
    archive_const(a, *number);
  } else if (const auto* text = value.get<std::string>()) {
    tag(Tag::text);
    archive_const(a, *text);
  } else if (const Table* table = value.table()) {
    tag(Tag::table);
    archive_const(a, table->items.size());
    for (const Value& item : table->items)
      write(a, item);
    archive_const(a, table->named.size());
    for (const auto& [name, entry] : table->named) {
      archive_const(a, name);
      write(a, entry);
    }
  } else if (const auto pile = std::dynamic_pointer_cast<PileObject>(value.object())) {
    tag(Tag::pile);
    archive_const(a, pile_text(*pile));
  } else {
    tag(Tag::nil);
  }
}

constexpr int most_nested = 200; // tables within tables, as many as Lua's own parser allows

Value read(Reader& a, int nested = 0) {
  if (nested > most_nested)
    Reader::refuse();
  Tag tag = Tag::nil;
  archive(a, tag);
  std::int64_t integer = 0;
  double number = 0;
  std::string text;
  switch (tag) {
  case Tag::nil:
    return {};
  case Tag::no:
    return false;
  case Tag::yes:
    return true;
  case Tag::integer:
    archive(a, integer);
    return integer;
  case Tag::number:
    archive(a, number);
    return number;
  case Tag::text:
    archive(a, text);
    return text;
  case Tag::pile:
    archive(a, text);
    return pile_from(text, "checkpoint");
  case Tag::table:
    break;
  }
  Table table;
  for (std::size_t n = archive_size(a, 0); n > 0; --n)
    table.items.push_back(read(a, nested + 1));
  for (std::size_t n = archive_size(a, 0); n > 0; --n) {
    archive(a, text);
    table.named[text] = read(a, nested + 1);
  }
  return table;
}

bool is_plain(const Value& value) {
  if (value.reference() || (value.object() && !std::dynamic_pointer_cast<PileObject>(value.object())))
    return false;
  if (const Table* table = value.table()) {
    for (const Value& item : table->items)
      if (!is_plain(item))
        return false;
    for (const auto& [name, entry] : table->named)
      if (!is_plain(entry))
        return false;
  }
  return true;
}

Event read_event(Reader& a) {
  Event event;
  archive_all(a, event.kind, event.outcome, event.name, event.hash);
  event.value = read(a);
  return event;
}

} // namespace

std::string value_bytes(const Value& value) {
  if (!is_plain(value))
    throw std::logic_error("a value that no other rank can be told");
  Writer a;
  write(a, value);
  return a.take();
}

Value value_from(const std::string& bytes) {
  Reader a(bytes);
  return read(a);
}

void Journal::load(std::string text) {
  text_ = std::move(text);
  next_ = 0;
  replay_end_ = text_.size();
}

Event Journal::peek() const {
  Reader a(std::string_view(text_).substr(next_, replay_end_ - next_));
  return read_event(a);
}

Event Journal::take() {
  Reader a(std::string_view(text_).substr(next_, replay_end_ - next_));
  Event event = read_event(a);
  next_ = replay_end_ - a.left();
  return event;
}

void Journal::record(Event event) {
  if (full_)
    return;
  if (!is_plain(event.value)) {
    event.value = {};
    event.outcome = Event::Outcome::object;
  }
  Writer a;
  archive_all(a, event.kind, event.outcome, event.name, event.hash);
  write(a, event.value);
  if (text_.size() + a.text().size() > most) {
    full_ = true;
    text_ = {};
    next_ = replay_end_ = 0;
    return;
  }
  text_ += a.text();
}

} // namespace cdem::script
