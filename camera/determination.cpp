// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/determination.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace tranos::camera {

namespace {

using Kind = Quantity::Kind;

// Singular values of the scaled Jacobian, with zeros where there are fewer rows than columns, and
// the directions they belong to.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd directions;
  int rank = 0;
};

Spectrum SpectrumOf(const Eigen::MatrixXd& scaled) {
  const Eigen::Index columns = scaled.cols();
  // The triangle of a QR decomposition has the same singular values and few rows.
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(columns, columns);
  if (scaled.rows() > columns) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(scaled);
    square = qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  } else {
    square.topRows(scaled.rows()) = scaled;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(square, Eigen::ComputeFullV);
  Spectrum spectrum{svd.singularValues(), svd.matrixV()};
  const double least = 1e-8 * spectrum.values[0];
  while (spectrum.rank < columns && spectrum.values[spectrum.rank] > least) ++spectrum.rank;
  return spectrum;
}

constexpr double kShare = 1e-6;
constexpr const char* kPrincipalPoint = "principal point";

// In scales: what data alone must tell, and what priors must leave. With priors a number is given
// as theirs and its deviation is told, however large, until nothing is left of the number: until f
// is as uncertain as it is long, or the principal point is anywhere in the frame.
constexpr double kDataLimit = 1, kPriorLimit = 5;

struct Judgement {
  std::vector<bool> determined;
  Eigen::MatrixXd covariance;  // scaled
  Eigen::MatrixXd open;        // directions that are free, or too weak to be told
  Eigen::Index rank = 0;
};

// `limit`: the deviation, in scales, with which a quantity that has a limit is none any more.
Judgement JudgementOf(const Spectrum& s, const std::vector<Quantity>& quantities, double limit) {
  const Eigen::Index n = s.values.size();
  Judgement judgement;
  judgement.rank = s.rank;
  judgement.determined.assign(static_cast<std::size_t>(n), true);
  const Eigen::MatrixXd by_deviation =
      s.directions.leftCols(s.rank) * s.values.head(s.rank).cwiseInverse().asDiagonal();
  judgement.covariance = by_deviation * by_deviation.transpose();
  bool limit_is_passed = false;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool is_free = s.directions.row(i).tail(n - s.rank).norm() > kShare;
    const bool is_limited = quantities[i].kind == Kind::kLimited;
    const bool is_weak = is_limited && judgement.covariance(i, i) >= limit * limit;
    judgement.determined[i] = !is_free && !is_weak;
    limit_is_passed = limit_is_passed || (is_limited && !judgement.determined[i]);
  }
  // A deviation of `limit` and more in a direction is a singular value of its inverse and less.
  Eigen::Index told = s.rank;
  while (limit_is_passed && told > 0 && limit * s.values[told - 1] <= 1) --told;
  judgement.open = s.directions.rightCols(n - told);
  for (Eigen::Index i = 0; i < n && told < s.rank; ++i) {
    if (quantities[i].kind != Kind::kPosition) continue;
    const double weak = (judgement.open.row(i).head(s.rank - told).transpose().array() /
                         s.values.segment(told, s.rank - told).array())
                            .matrix()
                            .norm();
    if (weak >= limit) judgement.determined[i] = false;
  }
  return judgement;
}

std::string Listed(const std::vector<std::string>& terms) {
  std::string text;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == terms.size() ? " and " : ", ") + terms[i];
  }
  return text;
}

// What would determine a camera: a prior on the principal point, too, unless there is one.
std::string Advice(const std::vector<Quantity>& quantities) {
  const bool is_free = std::ranges::any_of(quantities, [](const Quantity& quantity) {
    return quantity.term == kPrincipalPoint && !quantity.has_prior;
  });
  if (!is_free) return "a second independent ratio or a third dimension";
  return "a second independent ratio, a third dimension or a prior on the principal point";
}

// The rows of `open` of quantities that satisfy a condition.
template <class Condition>
Eigen::MatrixXd RowsWhere(const Eigen::MatrixXd& open, const std::vector<Quantity>& quantities,
                          Condition holds) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    if (holds(quantities[i])) rows.push_back(i);
  }
  return open(rows, Eigen::all);
}

constexpr double kPart = 0.02;  // in scales, from which on a quantity takes part in a direction

// Whether no direction is left open once the quantities of these rows are known.
bool Close(const Eigen::MatrixXd& rows) {
  if (rows.rows() < rows.cols()) return false;
  return Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues().tail(1)[0] > kPart;
}

bool IsUnknown(const Quantity& quantity) { return quantity.kind == Kind::kUnknown; }

// What would close directions of which the camera's own parameters are a part. Where the unknowns
// that go with them leave nothing open once they are known, that comes first; a single ratio, or
// the two numbers of the principal point, then closes only as many directions as it has numbers.
std::string AdviceFor(const Eigen::MatrixXd& open, const std::vector<Quantity>& quantities,
                      const std::vector<std::string>& unknowns) {
  if (!Close(RowsWhere(open, quantities, IsUnknown))) return Advice(quantities);
  std::string text = "a known length, ";
  if (open.cols() == 1) text += "a second independent ratio, ";
  const Eigen::MatrixXd principal = RowsWhere(open, quantities, [](const Quantity& quantity) {
    return quantity.term == kPrincipalPoint && !quantity.has_prior;
  });
  if (Close(principal)) text += "a prior on the principal point, ";
  const bool is_measured = std::ranges::any_of(quantities, [&](const Quantity& quantity) {
    return IsUnknown(quantity) && quantity.is_measured &&
           std::ranges::find(unknowns, quantity.term) != unknowns.end();
  });
  return text + (is_measured ? "or a smaller deviation of " : "or a deviation of ") +
         Listed(unknowns);
}

// What trades off in some directions (columns of `open`), and what would close them.
std::string Sentence(const Eigen::MatrixXd& open, const std::vector<Quantity>& quantities) {
  std::vector<std::string> terms, unknowns;
  bool has_limited = false, has_position = false;
  double largest = 0;
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    if (quantities[i].kind != Kind::kNuisance) largest = std::max(largest, open.row(i).norm());
  }
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    const Quantity& quantity = quantities[i];
    if (quantity.kind == Kind::kNuisance || open.row(i).norm() <= kPart * largest) continue;
    has_limited = has_limited || quantity.kind == Kind::kLimited;
    has_position = has_position || quantity.kind == Kind::kPosition;
    if (std::ranges::find(terms, quantity.term) != terms.end()) continue;
    terms.push_back(quantity.term);
    if (IsUnknown(quantity)) unknowns.push_back(quantity.term);
  }
  const std::string what =
      Listed(terms) + (terms.size() > 1 ? " trade off: " : " is not seen by anything traced: ");
  if (has_limited) return what + AdviceFor(open, quantities, unknowns) + " closes it";
  if (unknowns.size() == 1 && !has_position)
    return what + "a trace of what depends on it, or a deviation of the unknown, closes it";
  if (!unknowns.empty()) return what + "a known length, or a deviation of the unknown, closes it";
  return what + "an edge or a point with a known place, or a known length, closes it";
}

// Directions that move the camera's own parameters may be told with any of the `rest` added to
// them: what those can undo of the unknowns' part in them is no part of theirs.
void LeaveUnknownsTo(const Eigen::MatrixXd& rest, const std::vector<Quantity>& quantities,
                     Eigen::MatrixXd* moving) {
  const Eigen::MatrixXd undone = RowsWhere(rest, quantities, IsUnknown);
  if (undone.size() == 0) return;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(undone, Eigen::ComputeThinU);
  const Eigen::Index rank = (svd.singularValues().array() > kShare).count();
  const Eigen::MatrixXd basis = svd.matrixU().leftCols(rank);
  const Eigen::MatrixXd part = RowsWhere(*moving, quantities, IsUnknown);
  const Eigen::MatrixXd left = part - basis * (basis.transpose() * part);
  for (Eigen::Index i = 0, row = 0; i < moving->rows(); ++i) {
    if (IsUnknown(quantities[static_cast<std::size_t>(i)])) moving->row(i) = left.row(row++);
  }
}

// A sentence for the directions that move the camera's own parameters, one for those of the rest
// that move unknowns, such as scale, and one for place: what closes one of them does not close
// another.
std::vector<std::string> SentencesOf(const Eigen::MatrixXd& open,
                                     const std::vector<Quantity>& quantities) {
  std::vector<std::string> sentences;
  Eigen::MatrixXd rest = open;
  for (const Kind kind : {Kind::kLimited, Kind::kUnknown, Kind::kPosition}) {
    if (rest.cols() == 0) break;
    const Eigen::MatrixXd moved = RowsWhere(
        rest, quantities, [kind](const Quantity& quantity) { return quantity.kind == kind; });
    if (moved.rows() == 0) continue;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(moved, Eigen::ComputeFullV);
    const Eigen::Index count = (svd.singularValues().array() > kShare).count();
    if (count == 0) continue;
    const Eigen::MatrixXd turned = rest * svd.matrixV();
    rest = turned.rightCols(rest.cols() - count);
    Eigen::MatrixXd moving = turned.leftCols(count);
    if (kind == Kind::kLimited) LeaveUnknownsTo(rest, quantities, &moving);
    sentences.push_back(Sentence(moving, quantities));
  }
  return sentences;
}

// The measured unknowns whose own deviations give nearly all that is known in the open directions;
// none where one is free, or where traces have a part in it. In scaled units the row of a measured
// unknown is a unit vector, so that its part of a direction's information is a square of it.
std::vector<std::string> HoldersOf(const Spectrum& s, const Judgement& judgement,
                                   const std::vector<Quantity>& quantities) {
  constexpr double kNearlyAll = 0.9, kSome = 0.1;
  const Eigen::Index n = s.values.size(), first = n - judgement.open.cols();
  if (s.rank < n) return {};
  std::vector<std::string> holders;
  for (Eigen::Index k = first; k < n; ++k) {
    double held = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!quantities[i].is_measured) continue;
      const double share = std::pow(s.directions(i, k) / s.values[k], 2);
      held += share;
      if (share > kSome && std::ranges::find(holders, quantities[i].term) == holders.end())
        holders.push_back(quantities[i].term);
    }
    if (held < kNearlyAll) return {};
  }
  return holders;
}

std::string HeldSentence(const Judgement& by_data, const std::vector<std::string>& holders,
                         const std::vector<Quantity>& quantities) {
  std::vector<std::string> terms;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (by_data.determined[i] || quantities[i].kind == Kind::kNuisance) continue;
    if (std::ranges::find(terms, quantities[i].term) == terms.end())
      terms.push_back(quantities[i].term);
  }
  return "only the stated deviation of " + Listed(holders) + " holds " + Listed(terms) +
         ", too loosely to tell: a smaller one, " + Advice(quantities) + " closes it";
}

}  // namespace

std::vector<Quantity> QuantitiesOf(const Camera& camera, const Frame& frame, double distance_m) {
  const double angle = 2 * kPi / 180, place = 0.1 * distance_m, principal = 0.2 * frame.size_mm.x();
  return {{Kind::kLimited, 0.2 * std::abs(camera[kFocal]), "focal length"},
          {Kind::kLimited, 0.2, "aspect"},
          {Kind::kLimited, principal, kPrincipalPoint},
          {Kind::kLimited, principal, kPrincipalPoint},
          {Kind::kLimited, angle, "skew"},
          {Kind::kLimited, angle, "tilt"},
          {Kind::kLimited, angle, "pan"},
          {Kind::kLimited, angle, "swing"},
          {Kind::kPosition, place, "position"},
          {Kind::kPosition, place, "position"},
          {Kind::kPosition, place, "position"}};
}

Determination Determine(const Eigen::MatrixXd& jacobian, int data_rows,
                        const std::vector<Quantity>& quantities) {
  const auto n = static_cast<Eigen::Index>(quantities.size());
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) scale[i] = quantities[i].scale;
  const Eigen::MatrixXd scaled = jacobian * scale.asDiagonal();
  const Spectrum data = SpectrumOf(scaled.topRows(data_rows));
  const bool has_priors = data_rows < jacobian.rows();
  const Judgement by_data = JudgementOf(data, quantities, kDataLimit);
  const Judgement with_priors =
      has_priors ? JudgementOf(SpectrumOf(scaled), quantities, kPriorLimit) : by_data;
  Determination result;
  result.by_data = by_data.determined;
  result.with_priors = with_priors.determined;
  result.free_directions = static_cast<int>(n) - data.rank;
  result.rank = static_cast<int>(has_priors ? with_priors.rank : data.rank);
  result.inverse_information = scale.asDiagonal() * with_priors.covariance * scale.asDiagonal();
  result.covariance = result.inverse_information;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (result.with_priors[i]) continue;
    result.covariance.row(i).setZero();
    result.covariance.col(i).setZero();
  }
  bool is_open = false;
  for (Eigen::Index i = 0; i < n; ++i) {
    is_open = is_open || (!by_data.determined[i] && quantities[i].kind != Kind::kNuisance);
  }
  if (!is_open) return result;
  const std::vector<std::string> holders = HoldersOf(data, by_data, quantities);
  if (holders.empty()) {
    result.undetermined = SentencesOf(by_data.open, quantities);
  } else {
    result.undetermined.push_back(HeldSentence(by_data, holders, quantities));
  }
  return result;
}

}  // namespace tranos::camera
