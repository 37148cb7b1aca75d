// SPDX-License-Identifier: GPL-3.0-or-later
// A value of the language: sixteen bytes, copied freely. Numbers, booleans and nothing are held in
// place; the rest is behind a counted pointer to something immutable.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/primitives.h"
#include "model/dimension.h"
#include "model/hash.h"

namespace tranos::model {

struct Element;
class Value;

using SourceId = std::uint32_t;  // one unknown, or one evaluation of a `+-` literal

// A number's first-order dependence on the sources it came from: ∂value/∂source, by source.
struct Derivatives {
  std::vector<std::pair<SourceId, double>> terms;  // sorted by source
  bool last_is_written = false;  // of `a +- s` as it stands: the last term is the s
};
struct Uncertain {
  double value;
  Derivatives derivatives;
};
struct ValueRange {
  double from, to;  // both ends in
};
struct Record;
struct Closure;

class Value {
 public:
  enum class Kind : std::uint8_t {
    kNone,
    kNumber,
    kBoolean,
    kUncertain,
    kString,
    kList,
    kRange,
    kPlane,
    kElement,
    kClosure,
    kRecord,
  };

  Value() = default;
  static Value Number(double number, Dimension dimension = kPlain) {
    Value v;
    v.kind_ = Kind::kNumber;
    v.dimension_ = dimension;
    v.number_ = number;
    return v;
  }
  // `from_unknown`: it was decided by the value of an unknown.
  static Value Boolean(bool boolean, bool from_unknown = false) {
    Value v;
    v.kind_ = Kind::kBoolean;
    v.truth_ = {boolean, from_unknown};
    return v;
  }
  static Value Uncertain(model::Uncertain number, Dimension dimension);
  static Value String(std::string text);
  static Value List(std::vector<Value> items);
  static Value Range(ValueRange range, Dimension dimension);
  static Value Plane(const geom::Frame& plane);
  static Value OfElement(std::shared_ptr<const Element> element);
  static Value OfClosure(Closure closure);
  static Value OfRecord(Record record);
  static Value OfPoint(const geom::Vec3& point_m);  // a list of three lengths

  Value(const Value& other) { CopyFrom(other); }
  Value(Value&& other) noexcept { StealFrom(other); }
  Value& operator=(const Value& other) {
    if (this != &other) {
      Value copy(other);
      Release();
      StealFrom(copy);
    }
    return *this;
  }
  Value& operator=(Value&& other) noexcept {
    if (this != &other) {
      Release();
      StealFrom(other);
    }
    return *this;
  }
  ~Value() { Release(); }

  Kind kind() const { return kind_; }
  bool is_none() const { return kind_ == Kind::kNone; }
  bool is_number() const { return kind_ == Kind::kNumber || kind_ == Kind::kUncertain; }
  bool is_string() const { return kind_ == Kind::kString; }
  bool is_list() const { return kind_ == Kind::kList; }
  bool is_element() const { return kind_ == Kind::kElement; }
  bool is_boolean() const { return kind_ == Kind::kBoolean; }

  Dimension dimension() const { return dimension_; }  // of a number or range
  double number() const;                              // of a number, uncertain ones too
  const Derivatives* derivatives() const;             // null for a plain number
  bool boolean() const { return truth_.is; }
  bool from_unknown() const { return is_boolean() && truth_.from_unknown; }
  const std::string& string() const;
  const std::vector<Value>& list() const;
  const ValueRange& range() const;
  const geom::Frame& plane() const;
  const std::shared_ptr<const Element>& element() const;
  const Closure& closure() const;
  const Record& record() const;

  // Whether it is an element, or a list with one somewhere in it.
  bool holds_elements() const { return holds_elements_; }

  // A number in place, without derivatives: the interpreter's fast path.
  bool fast_number() const { return kind_ == Kind::kNumber; }
  double fast_value() const { return number_; }

 private:
  struct Heap;
  template <class T>
  struct HeapOf;
  template <class T>
  static Value Make(Kind kind, Dimension dimension, T content);
  template <class T>
  const T& Get() const;
  bool is_heap() const { return kind_ > Kind::kBoolean; }
  void CopyFrom(const Value& other) {
    kind_ = other.kind_;
    dimension_ = other.dimension_;
    holds_elements_ = other.holds_elements_;
    number_ = other.number_;
    if (is_heap()) AddReference();
  }
  void StealFrom(Value& other) {
    kind_ = other.kind_;
    dimension_ = other.dimension_;
    holds_elements_ = other.holds_elements_;
    number_ = other.number_;
    other.kind_ = Kind::kNone;
    other.holds_elements_ = false;
  }
  void Release() {
    if (is_heap()) DropReference();
    kind_ = Kind::kNone;
    holds_elements_ = false;
  }
  void AddReference() const;
  void DropReference();
  void FreeNested();

  Kind kind_ = Kind::kNone;
  Dimension dimension_;
  bool holds_elements_ = false;  // of an element, and of a list with one somewhere in it
  struct Truth {
    bool is;
    bool from_unknown;
  };
  union {
    double number_ = 0;  // NOLINT(readability-identifier-naming)
    Truth truth_;        // NOLINT(readability-identifier-naming)
    Heap* heap_;         // NOLINT(readability-identifier-naming)
  };
};
static_assert(sizeof(Value) == 16);

// Named values that belong together: a bounding box, an interface.
struct Record {
  std::string type;  // "bounding box", for messages
  std::vector<std::pair<std::string, Value>> members;

  const Value* Find(std::string_view name) const {
    for (const auto& [key, value] : members) {
      if (key == name) return &value;
    }
    return nullptr;
  }
};

// A function as a value; `code` is interp's own, carried and never read here, and holds no values:
// those that it captured may be functions too, and so on without bound.
struct Closure {
  std::shared_ptr<const void> code;
  std::vector<Value> captured = {};
};

// Same kind, dimension and content, derivatives included; elements by content.
bool Same(const Value& a, const Value& b);
void AddToHash(Hasher& hasher, const Value& value);

}  // namespace tranos::model
