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

// What trades off in some directions (columns of `open`), and what would close them.
std::string Sentence(const Eigen::MatrixXd& open, const std::vector<Quantity>& quantities) {
  std::vector<std::string> terms;
  bool has_limited = false, has_unknown = false;
  double largest = 0;
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    if (quantities[i].kind != Kind::kNuisance) largest = std::max(largest, open.row(i).norm());
  }
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    const Quantity& quantity = quantities[i];
    if (quantity.kind == Kind::kNuisance || open.row(i).norm() <= 0.02 * largest) continue;
    has_limited = has_limited || quantity.kind == Kind::kLimited;
    has_unknown = has_unknown || quantity.kind == Kind::kUnknown;
    if (std::ranges::find(terms, quantity.term) == terms.end()) terms.push_back(quantity.term);
  }
  const std::string what =
      Listed(terms) + (terms.size() > 1 ? " trade off: " : " is not seen by anything traced: ");
  if (has_limited) {
    return what + Advice(quantities) + " closes it";
  }
  if (has_unknown) return what + "a known length, or a deviation of the unknown, closes it";
  return what + "an edge or a point with a known place, or a known length, closes it";
}

std::vector<std::string> SentencesOf(const Eigen::MatrixXd& open,
                                     const std::vector<Quantity>& quantities) {
  if (open.cols() == 0) return {};  // an empty matrix has no rows to look at, either
  // Directions that move nothing but the position are scale and place, and are told apart from
  // those of which the camera's own parameters are a part.
  Eigen::MatrixXd inner = open;
  for (Eigen::Index i = 0; i < open.rows(); ++i) {
    if (quantities[i].kind == Kind::kNuisance || quantities[i].kind == Kind::kPosition)
      inner.row(i).setZero();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(inner, Eigen::ComputeFullV);
  Eigen::Index mixed = 0;
  while (mixed < svd.singularValues().size() && svd.singularValues()[mixed] > kShare) ++mixed;
  const Eigen::MatrixXd turned = open * svd.matrixV();
  std::vector<std::string> sentences;
  if (mixed > 0) sentences.push_back(Sentence(turned.leftCols(mixed), quantities));
  if (mixed == open.cols()) return sentences;
  const Eigen::MatrixXd outer = turned.rightCols(open.cols() - mixed);
  for (Eigen::Index i = 0; i < outer.rows(); ++i) {
    if (quantities[i].kind != Kind::kPosition || !(outer.row(i).norm() > kShare)) continue;
    sentences.push_back(Sentence(outer, quantities));
    break;
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
