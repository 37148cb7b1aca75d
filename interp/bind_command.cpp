// SPDX-License-Identifier: GPL-3.0-or-later
// Commands and key-ins: words find their row, keys find who they belong to.
#include "interp/binder.h"
#include "interp/functions.h"

namespace tranos::interp {

using model::Value;

namespace {

std::string Join(const std::vector<std::string>& words, std::size_t count) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += (i ? " " : "") + words[i];
  return out;
}

}  // namespace

// Longest words first; a definition in a block around comes before a built-in command and before
// one of the library.
const Command* Binder::LookUpCommand(const std::vector<NodeId>& words, std::size_t* used) {
  std::vector<std::string> lower;
  for (NodeId word : words) {
    lower.push_back(Lower(word));
    if (lower.size() == 6) break;
  }
  for (std::size_t count = lower.size(); count > 0; --count) {
    const std::string joined = Join(lower, count);
    *used = count;
    for (const Scope* scope = scope_; scope; scope = scope->parent) {
      if (in_library_ && !scope->parent)
        break;  // a family's elements are bound when reached, below
      const auto found = scope->definitions.find(joined);
      if (found != scope->definitions.end()) return &program_->definitions[found->second].row;
    }
    if (const Command* row = FindCommand(joined)) return row;
    if (const Command* row = LibraryCommand(joined)) return row;
  }
  return nullptr;
}

void Binder::UnknownCommand(const std::vector<NodeId>& words) {
  std::vector<std::string> lower;
  for (NodeId word : words) lower.push_back(Lower(word));
  std::vector<std::string> known;
  for (const Command& row : AllCommands()) known.emplace_back(row.words);
  for (const Scope* scope = scope_; scope; scope = scope->parent) {
    for (const auto& [definition, index] : scope->definitions) known.push_back(definition);
  }
  for (const std::string& element : library().Words()) known.push_back(element);
  const std::string joined = Join(lower, lower.size());
  // A unique beginning is offered, and so is the nearest spelling.
  std::vector<std::string> begun;
  for (const std::string& command : known) {
    if (command.rfind(joined, 0) == 0) begun.push_back(command);
  }
  std::optional<std::string> meant;
  if (begun.size() == 1) meant = begun[0];
  for (std::size_t count = std::min<std::size_t>(lower.size(), 4); !meant && count > 0; --count) {
    meant = DidYouMean(Join(lower, count), known);
  }
  Span span = SpanOf(words.front());
  span.end = SpanOf(words[std::min<std::size_t>(words.size(), 4) - 1]).end;
  std::string help = meant ? "did you mean `" + *meant + "`?" : "tranos help lists the commands";
  if (!meant && begun.size() > 1) {
    help = "commands that begin so:";
    for (std::size_t i = 0; i < begun.size() && i < 6; ++i)
      help += (i ? ", `" : " `") + begun[i] + "`";
  }
  Error(Code::kUnknownCommand, span, "there is no command `" + Printable(joined) + "`", "", help);
}

std::uint32_t Binder::UseOf(const Command* row, std::int32_t definition) {
  const auto [found, is_new] =
      uses_.emplace(row, static_cast<std::uint32_t>(program_->rows.size()));
  if (is_new) {
    program_->rows.push_back(row);
    program_->row_definition.push_back(definition);
  }
  return found->second;
}

void Binder::BindCommand(NodeId id) {
  const auto kids = Kids(id);
  std::vector<NodeId> words;
  for (NodeId kid : kids) {
    if (KindOf(kid) != NodeKind::kWord) break;
    words.push_back(kid);
  }
  if (words.empty()) return;
  std::size_t used = 0;
  const Command* row = LookUpCommand(words, &used);
  if (!row) return UnknownCommand(words);
  std::int32_t definition = -1;
  for (std::size_t i = 0; i < program_->definitions.size() && definition < 0; ++i) {
    if (&program_->definitions[i].row == row) definition = static_cast<std::int32_t>(i);
  }
  Span span = SpanOf(words.front());
  span.end = SpanOf(words[used - 1]).end;
  if (definition < 0 && !row->exists()) {
    return Error(Code::kNotYet, span, "`" + std::string(row->words) + "` is not there yet",
                 "part of the language, but not of this version");
  }
  if (definition >= 0) {
    unit().calls.push_back(program_->definitions[static_cast<std::size_t>(definition)].unit);
  }
  if (row->calibrates) {
    if (!at_top_ || in_used_file_ || in_definition_) {
      return Error(Code::kMisplaced, span, "`calibrate` stands at the top of a script",
                   "inside a block here");
    }
    if (program_->calibrates) {
      return Error(Code::kMisplaced, span, "`calibrate` stands once in a script",
                   "it adjusts all photographs attached before it");
    }
    program_->calibrates = true;
  }
  Emit({Op::kStart, 0, 0, UseOf(row, definition), 0, 0}, span);
  scope_->command = row;
  scope_->command_statement = statement_;
  BindArguments(kids, used, row, statement_);
}

void Binder::BindArguments(const std::vector<NodeId>& args, std::size_t first, const Command* row,
                           std::uint32_t statement) {
  for (std::size_t i = first; i < args.size(); ++i) {
    const std::uint32_t mark = builder_->next_register;
    const NodeId arg = args[i];
    switch (KindOf(arg)) {
      case NodeKind::kWord:
      case NodeKind::kNumber:
        // The words of a command that lacks its separator are one mistake.
        if (!BindWord(arg, row)) {
          while (i + 1 < args.size() && KindOf(args[i + 1]) == NodeKind::kWord) ++i;
        }
        break;
      case NodeKind::kString:
        if (!row || row->string_key.empty()) {
          Error(Code::kUnknownWord, SpanOf(arg), "a string has no meaning here", "",
                row ? "`" + std::string(row->words) + "` takes no string by itself"
                    : "give it as a key: key=\"…\"");
          break;
        }
        Emit({Op::kBareString, 0, 0, 0,
              ConvertedOperand(Expression(arg), Type::kString, false, row->string_key, SpanOf(arg)),
              0},
             SpanOf(arg));
        break;
      case NodeKind::kKeyIn:
        BindKeyIn(arg, statement);
        break;
      case NodeKind::kReset:
        Emit({Op::kReset}, SpanOf(arg));
        break;
      case NodeKind::kNaming:
        BindNaming(arg);
        break;
      default:
        break;
    }
    builder_->next_register = mark;
  }
  Span end = args.empty() ? Span{tree_->file, 0, 0} : SpanOf(args.back());
  if (!args.empty()) end.begin = SpanOf(args.front()).begin;
  Emit({Op::kEndStatement}, end);
}

// Whether a command's first word is this: then its separator was forgotten.
bool Binder::BeginsCommand(std::string_view word) const {
  const auto begins = [&](std::string_view words) {
    return words.substr(0, words.find(' ')) == word;
  };
  for (const Command& row : AllCommands()) {
    if (begins(row.words)) return true;
  }
  return false;
}

bool Binder::BindWord(NodeId id, const Command* row) {
  const std::string word = Text(id);
  if (row && HasWord(row->options, word)) {
    Emit({Op::kOption, 0, 0, AddText(LowerCase(word)), 0, 0}, SpanOf(id));
    return true;
  }
  if (row && !row->asks.empty()) {
    Emit({Op::kOption, 0, 0, AddText(word), 0, 0}, SpanOf(id));
    return true;
  }
  const std::string in_text =
      row && !row->string_key.empty()
          ? "`" + std::string(row->words) + " \"{" + word + "}\"` shows it in a text"
          : "";
  if (KindOf(id) == NodeKind::kNumber) {
    Error(Code::kUnknownWord, SpanOf(id), "a number has no meaning here", "",
          in_text.empty() ? "values are given by key=" : in_text);
    return false;
  }
  std::string help = "values are given by key=, a variable's too";
  if (!in_text.empty() && (Find(word) || row->words == "print")) {
    help = in_text;
  } else if (!row || BeginsCommand(LowerCase(word))) {
    help = "a command starts a line or follows `;`";
  } else if (row) {
    if (const auto meant = DidYouMean(LowerCase(word), SplitWords(row->options))) {
      help = "did you mean `" + *meant + "`?";
    } else if (!row->options.empty()) {
      help = "its words are";
      for (const std::string& option : SplitWords(row->options)) help += " `" + option + "`";
    }
  }
  Error(Code::kUnknownWord, SpanOf(id),
        row ? "`" + std::string(row->words) + "` does not know the word `" + Printable(word) + "`"
            : "a word stands here, but no command begins with it",
        "", help);
  return false;
}

// The scope whose command the keys here belong to: the nearest before, in this block or one around.
Scope* Binder::CommandScope() {
  for (Scope* scope = scope_; scope; scope = scope->parent) {
    if (scope->command) return scope;
    if (scope->closed_to_commands) return nullptr;
  }
  return nullptr;
}

void Binder::BindKeyIn(NodeId id, std::uint32_t statement) {
  auto values = Kids(id);
  const NodeId word = values.front();
  values.erase(values.begin());
  if (values.empty()) return;  // an error, reported by the parser
  const std::string key = Lower(word);
  if (const PointKeyRow* point = FindPointKey(key)) return BindPoint(id, *point, values);
  Scope* const owner = CommandScope();
  const Command* const row = owner ? owner->command : nullptr;
  if (row) {
    for (std::size_t i = 0; i < row->keys.size(); ++i) {
      const Key& declared = row->keys[i];
      if (LowerCase(declared.name) != key) continue;
      if (row->manner == Manner::kImmediate && owner->command_statement != statement) {
        const std::string text = Text(id);
        return Error(
            Code::kKeyAfterSeparator, SpanOf(id),
            "`" + std::string(row->words) + "` has run already when `" + key + "=` is given", "",
            "write it in one statement: `" + std::string(row->words) + " " + Printable(text) + "`");
      }
      const Operand value =
          Typed(values, declared.type, declared.list, declared.words, declared.name, id);
      Span span = SpanOf(values.front());
      span.end = SpanOf(values.back()).end;
      Emit({Op::kParameterKey, 0, 0, static_cast<std::uint32_t>(i), value, 0}, span);
      return;
    }
  }
  if (const SettingRow* setting = FindSetting(key)) return BindSetting(id, *setting, values);
  UnknownKey(word, row);
}

void Binder::UnknownKey(NodeId word, const Command* row) {
  const std::string key = Lower(word);
  std::vector<std::string> known;
  if (row) {
    for (const Key& declared : row->keys) known.emplace_back(declared.name);
  }
  for (const SettingRow& setting : AllSettings()) known.emplace_back(setting.key);
  for (const PointKeyRow& point : AllPointKeys()) known.emplace_back(point.key);
  const auto meant = DidYouMean(key, known);
  std::string help;
  if (meant) {
    help = "did you mean `" + *meant + "=`?";
  } else if (row) {
    help = "tranos help " + std::string(row->words);
  } else {
    help = "`let " + Printable(Text(word)) + " = …` binds a value; the settings are";
    for (const SettingRow& setting : AllSettings()) help += " " + std::string(setting.key);
  }
  Error(Code::kUnknownKey, SpanOf(word),
        row ? "neither `" + std::string(row->words) + "` nor the settings have a key `" +
                  Printable(key) + "`"
            : "no setting is called `" + Printable(key) + "`, and no command is active here",
        "", help);
}

void Binder::BindPoint(NodeId id, const PointKeyRow& row, const std::vector<NodeId>& values) {
  const int count = static_cast<int>(values.size());
  if (count < row.least || count > row.most) {
    return Error(Code::kWrongCount, SpanOf(id),
                 "`" + std::string(row.key) + "=` is given " + std::to_string(count) + " values",
                 std::string(row.summary));
  }
  const auto type_of = [&](int i) {
    if (row.kind == PointKey::kDot) return Type::kPixel;
    return row.kind == PointKey::kDi && i == 1 ? Type::kAngle : Type::kLength;
  };
  const std::uint32_t first = builder_->next_register;
  // A point of literals is one constant: most points of a recorded session are.
  const auto single = [&](NodeId value, Type type) {
    return ConvertedOperand(Expression(value), type, false, row.key, SpanOf(value));
  };
  const Span span = SpanOf(id);
  const auto kind = static_cast<std::uint8_t>(row.kind);
  const auto packed = static_cast<std::uint8_t>(kind | kPackedPoint);
  if (row.kind == PointKey::kOn) {
    const Operand interface = single(values[0], Type::kAny);
    const Operand own =
        count == 1 ? AddText("") : Typed({values[1]}, Type::kName, false, {}, row.key, values[1]);
    Emit({Op::kPoint, packed, 0, own, interface, static_cast<std::uint32_t>(count)}, span);
    return;
  }
  if (count == 1 && row.kind != PointKey::kDl && row.kind != PointKey::kDx) {
    const Type whole = row.kind == PointKey::kDot ? Type::kDot : Type::kPoint;
    Emit({Op::kPoint, packed, 0, 0, single(values[0], whole), 1}, span);
    return;
  }
  std::vector<Value> constants;
  for (int i = 0; i < count; ++i) {
    const NodeId value = values[static_cast<std::size_t>(i)];
    const auto constant = Constant(value);
    if (!constant) break;
    try {
      constants.push_back(Convert(*constant, type_of(i), measure(), row.key));
    } catch (const OpFailure& failure) {
      return Report(failure, SpanOf(value));
    }
  }
  if (static_cast<int>(constants.size()) == count) {
    Emit({Op::kPoint, packed, 0, 0, AddConstant(Value::List(std::move(constants))),
          static_cast<std::uint32_t>(count)},
         span);
    return;
  }
  for (int i = 0; i < count; ++i) NewRegister();
  for (int i = 0; i < count; ++i) {
    const auto target = first + static_cast<std::uint32_t>(i);
    const NodeId value = values[static_cast<std::size_t>(i)];
    ExpressionInto(target, value);
    // dl= and dx= take a whole offset as one value, too.
    if (count == 1) break;
    Emit({Op::kConvert, static_cast<std::uint8_t>(type_of(i)), scope_->measure, target, target,
          AddText(row.key)},
         SpanOf(value));
  }
  Emit({Op::kPoint, kind, scope_->measure, 0, first, static_cast<std::uint32_t>(count)}, span);
}

void Binder::BindSetting(NodeId id, const SettingRow& row, const std::vector<NodeId>& values) {
  if (row.setting == SettingKey::kUnit) {
    const std::string name = values.size() == 1 ? Text(values[0]) : "";
    const auto index = FindMeasure(name);
    if (!index || program_->measures[*index].dimension != model::kLength) {
      std::vector<std::string> lengths;
      for (const Unit& unit_of_measure : program_->measures) {
        if (unit_of_measure.dimension == model::kLength) lengths.push_back(unit_of_measure.name);
      }
      const auto meant = DidYouMean(name, lengths);
      return Error(
          Code::kUnknownUnit, SpanOf(values[0]), "`un=` takes a unit of length by its name", "",
          meant ? "did you mean `" + *meant + "`?" : "m cm mm km ft in, or one declared by `unit`");
    }
    scope_->measure = *index;
    Emit({Op::kSetting, static_cast<std::uint8_t>(row.setting), *index, 0, AddText(name), 0},
         SpanOf(id));
    return;
  }
  const Operand value = Typed(values, row.type, false, row.words, row.key, id);
  Span span = SpanOf(values.front());
  span.end = SpanOf(values.back()).end;
  Emit({Op::kSetting, static_cast<std::uint8_t>(row.setting), scope_->measure, 0, value, 0}, span);
}

// `as NAME`: the name belongs to the nearest script, group or definition; in a loop it means this
// turn's.
void Binder::BindNaming(NodeId id) {
  const NodeId node = tree()[id].first_child;
  const std::string name = Text(node);
  if (!CheckName(name, SpanOf(node))) return;
  const auto interface = NamesScope()->interfaces.find(name);
  if (interface != NamesScope()->interfaces.end()) {
    return Error(Code::kBoundTwice, SpanOf(node), "`" + name + "` is an interface already",
                 "named again here", "parameters, parts and interfaces have names of their own",
                 {{interface->second, "declared here"}});
  }
  Scope* owner = NamesOwner();
  const std::uint32_t name_scope = NamesScope()->name_scope;
  const std::uint32_t index = NameIndex(name_scope, name);
  Symbol symbol{.kind = Symbol::kElementName,
                .unit = builder_->id,
                .index = index,
                .scope = name_scope,
                .declared = SpanOf(node)};
  std::uint32_t from = 0;
  std::uint8_t in_turn = 0;
  if (owner->is_turn) {
    const auto reg = owner->turn_registers.find(name);
    if (reg != owner->turn_registers.end()) {
      symbol.turn_register = reg->second;
      from = reg->second;
      in_turn = 1;
    }
  }
  // Anything else of this name, in the blocks up to where names belong, would be hidden.
  const Symbol* other = nullptr;
  for (const Scope* scope = scope_;; scope = scope->parent) {
    const auto known = scope->symbols.find(name);
    if (!other && known != scope->symbols.end() && known->second.kind != Symbol::kElementName)
      other = &known->second;
    if (scope->opens_names) break;
  }
  const auto found = owner->symbols.find(name);
  if (other) {
    return Error(Code::kBoundTwice, SpanOf(node), "`" + name + "` is bound already",
                 "named again here", "", {{other->declared, "first bound here"}});
  }
  if (found == owner->symbols.end()) owner->symbols.emplace(name, symbol);
  Emit({Op::kName, in_turn, 0, AddText(name), from, index}, SpanOf(node));
}

}  // namespace tranos::interp
