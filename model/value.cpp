// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/value.h"

#include <algorithm>
#include <new>
#include <unordered_map>

#include "model/element.h"

namespace tranos::model {

// The count stands first in every heap object, so that it is reached without knowing the content.
// Values belong to one thread, hence no atomic.
struct Value::Heap {
  std::uint32_t references = 1;
};

template <class T>
struct Value::HeapOf {
  Heap heap;
  T content;
};

template <class T>
Value Value::Make(Kind kind, Dimension dimension, T content) {
  Value value;
  value.kind_ = kind;
  value.dimension_ = dimension;
  value.heap_ = &(new HeapOf<T>{{}, std::move(content)})->heap;
  return value;
}

template <class T>
const T& Value::Get() const {
  return reinterpret_cast<const HeapOf<T>*>(heap_)->content;
}

Value Value::Uncertain(model::Uncertain number, Dimension dimension) {
  return Make(Kind::kUncertain, dimension, std::move(number));
}
Value Value::String(std::string text) { return Make(Kind::kString, kPlain, std::move(text)); }
Value Value::List(std::vector<Value> items) {
  const bool holds = std::any_of(items.begin(), items.end(),
                                 [](const Value& item) { return item.holds_elements_; });
  Value list = Make(Kind::kList, kPlain, std::move(items));
  list.holds_elements_ = holds;
  return list;
}
Value Value::Range(ValueRange range, Dimension dimension) {
  return Make(Kind::kRange, dimension, range);
}
Value Value::Plane(const geom::Frame& plane) { return Make(Kind::kPlane, kPlain, plane); }
Value Value::OfElement(std::shared_ptr<const Element> element) {
  Value value = Make(Kind::kElement, kPlain, std::move(element));
  value.holds_elements_ = true;
  return value;
}
Value Value::OfClosure(Closure closure) { return Make(Kind::kClosure, kPlain, std::move(closure)); }
Value Value::OfRecord(Record record) { return Make(Kind::kRecord, kPlain, std::move(record)); }
Value Value::OfPoint(const geom::Vec3& point_m) {
  return List(
      {Number(point_m.x(), kLength), Number(point_m.y(), kLength), Number(point_m.z(), kLength)});
}

double Value::number() const {
  return kind_ == Kind::kUncertain ? Get<model::Uncertain>().value : number_;
}
const Derivatives* Value::derivatives() const {
  return kind_ == Kind::kUncertain ? &Get<model::Uncertain>().derivatives : nullptr;
}
const std::string& Value::string() const { return Get<std::string>(); }
const std::vector<Value>& Value::list() const { return Get<std::vector<Value>>(); }
const ValueRange& Value::range() const { return Get<ValueRange>(); }
const geom::Frame& Value::plane() const { return Get<geom::Frame>(); }
const std::shared_ptr<const Element>& Value::element() const {
  return Get<std::shared_ptr<const Element>>();
}
const Closure& Value::closure() const { return Get<Closure>(); }
const Record& Value::record() const { return Get<Record>(); }

void Value::AddReference() const { ++heap_->references; }

void Value::DropReference() {
  if (--heap_->references > 0) return;
  const auto free_as = [this]<class T>() { delete reinterpret_cast<HeapOf<T>*>(heap_); };
  switch (kind_) {
    case Kind::kUncertain:
      return free_as.operator()<model::Uncertain>();
    case Kind::kString:
      return free_as.operator()<std::string>();
    case Kind::kList:
    case Kind::kClosure:
    case Kind::kRecord:
      return FreeNested();
    case Kind::kRange:
      return free_as.operator()<ValueRange>();
    case Kind::kPlane:
      return free_as.operator()<geom::Frame>();
    case Kind::kElement:
      return free_as.operator()<std::shared_ptr<const Element>>();
    case Kind::kNone:
    case Kind::kNumber:
    case Kind::kBoolean:
      return;
  }
}

// Lists, records and functions may nest deeper than the call stack: the values in one that goes
// with this one move to a heap-allocated stack first, so that each that is deleted holds none any
// more. The stack begins as the list itself and takes only what may nest: freeing must not need
// memory when there is none. Should it all the same, what is left is freed by recursion.
void Value::FreeNested() {
  std::vector<Value> pending;
  const auto push = [&pending](Value& value) {
    if (value.kind_ != Kind::kList && value.kind_ != Kind::kClosure && value.kind_ != Kind::kRecord)
      return;
    try {
      pending.push_back(std::move(value));
    } catch (const std::bad_alloc&) {
    }
  };
  const auto take_from = [&](Kind kind, Heap* heap) {
    const auto take = [&](std::vector<Value>& values) {
      if (pending.capacity() == 0) return pending.swap(values);
      for (Value& value : values) push(value);
      values.clear();
    };
    if (kind == Kind::kList) take(reinterpret_cast<HeapOf<std::vector<Value>>*>(heap)->content);
    if (kind == Kind::kClosure) take(reinterpret_cast<HeapOf<Closure>*>(heap)->content.captured);
    if (kind != Kind::kRecord) return;
    for (auto& [name, value] : reinterpret_cast<HeapOf<Record>*>(heap)->content.members) {
      push(value);
    }
  };
  take_from(kind_, heap_);
  while (!pending.empty()) {
    const Value item = std::move(pending.back());
    pending.pop_back();
    if (item.is_heap() && item.heap_->references == 1) take_from(item.kind_, item.heap_);
  }
  if (kind_ == Kind::kList) delete reinterpret_cast<HeapOf<std::vector<Value>>*>(heap_);
  if (kind_ == Kind::kClosure) delete reinterpret_cast<HeapOf<Closure>*>(heap_);
  if (kind_ == Kind::kRecord) delete reinterpret_cast<HeapOf<Record>*>(heap_);
}

namespace {

// Records are small, and hold no other records but those that were made with them.
bool SameRecord(const Record& a, const Record& b) {
  if (a.type != b.type || a.members.size() != b.members.size()) return false;
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    if (a.members[i].first != b.members[i].first) return false;
    if (!Same(a.members[i].second, b.members[i].second)) return false;
  }
  return true;
}

void AddRecord(Hasher& hasher, const Record& record) {
  hasher.Text(record.type).Integer(static_cast<std::int64_t>(record.members.size()));
  for (const auto& [name, member] : record.members) AddToHash(hasher.Text(name), member);
}

bool SameFrame(const geom::Frame& a, const geom::Frame& b) {
  return a.origin == b.origin && a.x == b.x && a.y == b.y;
}

// Lists by their length alone: their items are compared by the caller.
bool SameButForItems(const Value& a, const Value& b) {
  if (a.kind() != b.kind() || a.dimension() != b.dimension()) return false;
  switch (a.kind()) {
    case Value::Kind::kNone:
      return true;
    case Value::Kind::kNumber:
      return a.number() == b.number();
    case Value::Kind::kBoolean:
      return a.boolean() == b.boolean();
    case Value::Kind::kUncertain:
      return a.number() == b.number() && a.derivatives()->terms == b.derivatives()->terms;
    case Value::Kind::kString:
      return a.string() == b.string();
    case Value::Kind::kList:
      return a.list().size() == b.list().size();
    case Value::Kind::kRange:
      return a.range().from == b.range().from && a.range().to == b.range().to;
    case Value::Kind::kPlane:
      return SameFrame(a.plane(), b.plane());
    case Value::Kind::kElement:
      return a.element()->hash == b.element()->hash;
    case Value::Kind::kClosure:
      return a.closure().code == b.closure().code;
    case Value::Kind::kRecord:
      return SameRecord(a.record(), b.record());
  }
  return false;
}

void AddNumber(Hasher& hasher, double number, Dimension dimension) {
  hasher.Tag(dimension.base).Integer(dimension.exponent);
  if (dimension == kLength) {
    hasher.Length(number);
  } else if (dimension == kAngle) {
    hasher.Angle(number);
  } else {
    hasher.Ratio(number);
  }
}

// As SameButForItems: a list adds its length alone.
void AddButForItems(Hasher& hasher, const Value& value) {
  hasher.Tag(static_cast<std::uint8_t>(value.kind()));
  switch (value.kind()) {
    case Value::Kind::kNone:
      break;
    case Value::Kind::kNumber:
      AddNumber(hasher, value.number(), value.dimension());
      break;
    case Value::Kind::kBoolean:
      hasher.Tag(value.boolean() ? 1 : 0);
      break;
    case Value::Kind::kUncertain:
      AddNumber(hasher, value.number(), value.dimension());
      hasher.Integer(static_cast<std::int64_t>(value.derivatives()->terms.size()));
      for (const auto& [source, slope] : value.derivatives()->terms) {
        hasher.Integer(source).Ratio(slope);
      }
      break;
    case Value::Kind::kString:
      hasher.Text(value.string());
      break;
    case Value::Kind::kList:
      hasher.Integer(static_cast<std::int64_t>(value.list().size()));
      break;
    case Value::Kind::kRange:
      AddNumber(hasher, value.range().from, value.dimension());
      AddNumber(hasher, value.range().to, value.dimension());
      break;
    case Value::Kind::kPlane:
      hasher.Point(value.plane().origin).Direction(value.plane().x).Direction(value.plane().y);
      break;
    case Value::Kind::kElement:
      hasher.Hash(value.element()->hash);
      break;
    case Value::Kind::kClosure:
      break;  // its code has no bytes that are the same in every run
    case Value::Kind::kRecord:
      AddRecord(hasher, value.record());
      break;
  }
}

}  // namespace

bool Same(const Value& a, const Value& b) {
  std::vector<std::pair<const Value*, const Value*>> pending = {{&a, &b}};
  while (!pending.empty()) {
    const auto [left, right] = pending.back();
    pending.pop_back();
    if (!SameButForItems(*left, *right)) return false;
    if (!left->is_list() || &left->list() == &right->list()) continue;
    for (std::size_t i = 0; i < left->list().size(); ++i) {
      pending.emplace_back(&left->list()[i], &right->list()[i]);
    }
  }
  return true;
}

void AddToHash(Hasher& hasher, const Value& value) {
  if (!value.is_list()) return AddButForItems(hasher, value);
  // Lists may be deep, and may share parts so often that their written-out length is beyond any
  // bound: each is hashed once, without descending by recursion.
  struct Open {
    const Value* list;
    std::size_t next;
    Hasher hasher;
  };
  std::unordered_map<const std::vector<Value>*, Hash128> known;
  std::vector<Open> open;
  const auto begin = [&](const Value& list) {
    open.push_back({&list, 0, {}});
    AddButForItems(open.back().hasher, list);
  };
  begin(value);
  while (!open.empty()) {
    Open& top = open.back();
    const std::vector<Value>& items = top.list->list();
    if (top.next == items.size()) {
      known.emplace(&items, top.hasher.Finish());
      open.pop_back();
      continue;
    }
    const Value& item = items[top.next];
    if (!item.is_list()) {
      AddButForItems(top.hasher, item);
      ++top.next;
    } else if (const auto found = known.find(&item.list()); found != known.end()) {
      top.hasher.Hash(found->second);
      ++top.next;
    } else {
      begin(item);
    }
  }
  hasher.Hash(known.at(&value.list()));
}

}  // namespace tranos::model
