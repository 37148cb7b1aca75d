// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/estimation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/space_traces.h"
#include "camera/vanishing_point.h"

namespace tranos::camera {

namespace {

// From the camera to the middle of the points it is known to see, or 10 m.
double DistanceOf(const Photograph& photograph, const Camera& camera, const Numbers& numbers) {
  Vec3 sum = Vec3::Zero();
  int points = 0;
  const auto add = [&](NumberIndex first) {
    sum += numbers.values.segment<3>(first);
    ++points;
  };
  for (const Trace& trace : photograph.traces) {
    if (const auto* edge = std::get_if<EdgeTrace>(&trace)) {
      add(edge->from), add(edge->to);
    } else if (const auto* point = std::get_if<PointTrace>(&trace)) {
      add(point->at);
    } else if (const auto* curve = std::get_if<CurveTrace>(&trace)) {
      add(curve->first);
    } else if (std::holds_alternative<RectangleTrace>(trace)) {
      ++points;  // the origin is on the first facade
    }
  }
  const double distance = points > 0 ? (sum / points - camera.position_m()).norm() : 0;
  return distance > 0 ? distance : 10;
}

std::vector<Quantity> QuantitiesOfAll(std::span<const Photograph> photographs,
                                      std::span<const Unknown> unknowns, const Layout& layout,
                                      const Refined& refined) {
  std::vector<Quantity> quantities;
  for (int p = 0; p < layout.cameras; ++p) {
    const Camera camera = CameraAt(refined.state, p);
    std::vector<Quantity> of_camera = QuantitiesOf(
        camera, photographs[p].frame, DistanceOf(photographs[p], camera, refined.numbers));
    for (int i = 0; i < kIntrinsics; ++i) {
      of_camera[i].has_prior = photographs[p].priors[i].sigma > 0;
    }
    std::ranges::move(of_camera, std::back_inserter(quantities));
  }
  for (int i = 0; i < layout.unknowns; ++i) {
    // A literal's error is near zero, so that its value says nothing of its size.
    const double value = std::abs(refined.state[layout.unknown_column() + i]);
    const double scale = unknowns[i].sigma > 0 ? unknowns[i].sigma : std::max(value, 1e-3);
    quantities.push_back(
        {Quantity::Kind::kUnknown, scale, NameOfUnknown(unknowns[i]), unknowns[i].sigma > 0});
  }
  quantities.resize(static_cast<std::size_t>(layout.columns));
  return quantities;
}

// C Jᵀ J C over the rows of each source adds up to C: how much variance came from where.
std::vector<Shares> SharesOf(const Layout& layout, const Determined& determined) {
  const Eigen::MatrixXd& covariance = determined.determination.inverse_information;
  const Eigen::MatrixXd moved = covariance * determined.jacobian.transpose();
  std::vector<Shares> shares(static_cast<std::size_t>(layout.columns));
  for (int i = 0; i < layout.columns; ++i) {
    const auto row = moved.row(i);
    const double pixels = row.head(layout.trace_rows).squaredNorm();
    const double metric = row.segment(layout.trace_rows, layout.unknown_prior_rows).squaredNorm();
    const double priors = row.tail(layout.camera_prior_rows).squaredNorm();
    const double sum = pixels + metric + priors;
    if (sum > 0) shares[i] = {pixels / sum, metric / sum, priors / sum};
  }
  return shares;
}

// Those of a photograph's camera, and then of the unknowns.
Eigen::VectorXi ColumnsOf(const Layout& layout, int photograph) {
  const int n = kParameters + layout.unknowns;
  Eigen::VectorXi columns(n);
  for (int i = 0; i < n; ++i) {
    columns[i] =
        i < kParameters ? kParameters * photograph + i : layout.unknown_column() + i - kParameters;
  }
  return columns;
}

// Angles outside which methods by vanishing points are near to where they break down, and inside
// which a tilted camera was meant (DESIGN.md; the paper's Section 6).
void WarnOfAngles(const Camera& camera, std::vector<std::string>& warnings) {
  const struct {
    const char* name;
    Parameter parameter;
  } angles[] = {{"tilt", kOmega}, {"pan", kPhi}};
  for (const auto& [name, parameter] : angles) {
    // From the nearer way along Y: the camera may stand behind the building.
    const double turned = std::fmod(std::abs(camera[parameter]) * 180 / kPi, 180);
    const double degrees = std::min(turned, 180 - turned);
    if (degrees >= 5 && degrees <= 40) continue;
    warnings.push_back(fmt::format(
        "the {} of {:.2f}° is outside 5° to 40°, where methods by vanishing points are weak", name,
        degrees));
  }
}

void WarnOfVanishingPoints(const Photograph& photograph, const Numbers& numbers,
                           std::vector<std::string>& warnings) {
  const AxisLines lines = AxisLinesOf(photograph, numbers);
  for (int axis = 0; axis < 3; ++axis) {
    if (lines[axis].size() < 2) continue;
    const auto point = FitVanishingPoint(lines[axis], ConditioningOf(photograph.frame));
    if (point && !point->nearly_degenerate() && point->FromInfinity() > 3) continue;
    warnings.push_back(fmt::format(
        "the edges along {} are parallel in the picture within noise: their vanishing point is "
        "nearly degenerate",
        "XYZ"[axis]));
  }
}

// What is open to one camera and the unknowns, whatever else is open to others.
std::vector<std::string> OpenOf(int photograph, const Layout& layout,
                                std::vector<Quantity> quantities, const Determined& determined) {
  for (int i = 0; i < layout.unknown_column(); ++i) {
    if (i / kParameters != photograph) quantities[i].kind = Quantity::Kind::kNuisance;
  }
  return Determine(determined.jacobian, layout.data_rows(), quantities).undetermined;
}

// A triangular root of the covariance of the unknowns, then all cameras, and then the facades, its
// rows in the order of the state: so the sources of the unknowns are the first ones, whatever a
// pose is. Rows of what is not determined, and of other nuisances, are zero.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& covariance, const Layout& layout) {
  constexpr double kRounding = 1e-13;
  std::vector<int> order;
  for (int i = layout.unknown_column(); i < layout.nuisance_column(); ++i) order.push_back(i);
  for (int i = 0; i < layout.unknown_column(); ++i) order.push_back(i);
  for (const int column : layout.facade_column) {
    if (column >= 0) order.insert(order.end(), {column, column + 1});
  }
  const int n = static_cast<int>(order.size());
  const Eigen::VectorXd sigma = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const auto scale = [&](int column) { return sigma[column] > 0 ? 1 / sigma[column] : 0.0; };
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(layout.columns, n);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) {
      const double correlation = covariance(order[i], order[j]) * scale(order[i]) * scale(order[j]);
      const double rest = correlation - root.row(order[i]).head(j).dot(root.row(order[j]).head(j));
      if (i == j && rest <= kRounding) break;
      root(order[i], j) = i == j ? std::sqrt(rest) : rest / root(order[j], j);
    }
  }
  return sigma.asDiagonal() * root;
}

// The first dot of the facade's first rectangle, on the facade; its foot if it has none.
Vec2 OriginOn(int facade, std::span<const Photograph> photographs, const Layout& layout,
              const Eigen::VectorXd& state) {
  for (const TraceRows& rows : layout.traces) {
    const auto* rectangle =
        std::get_if<RectangleTrace>(&photographs[rows.photograph].traces[rows.trace]);
    if (!rectangle || rectangle->facade != facade) continue;
    const int column = layout.trace_column[rows.photograph][rows.trace];
    return column < 0 ? Vec2(Vec2::Zero()) : Vec2(state.segment<2>(column));
  }
  return Vec2::Zero();
}

std::vector<FacadeEstimate> FacadesOf(std::span<const Photograph> photographs, const Layout& layout,
                                      const Refined& refined, const Determination& d,
                                      const Eigen::MatrixXd& root) {
  const Eigen::VectorXd& state = refined.state;
  const auto by_unknowns = root.middleRows(layout.unknown_column(), layout.unknowns);
  std::vector<FacadeEstimate> facades;
  for (int i = 0; i < static_cast<int>(layout.facade_column.size()); ++i) {
    const FacadePlane plane = PlaneOf(layout, refined.numbers, i, state);
    const Vec2 origin = OriginOn(i, photographs, layout, state);
    FacadeEstimate& facade = facades.emplace_back();
    facade.plane = {plane.Point(origin), plane.right(), Vec3::UnitZ()};
    facade.deviations = Eigen::MatrixXd::Zero(3, root.cols());
    const int column = layout.facade_column[static_cast<std::size_t>(i)];
    const NumberIndex given = layout.facade_number[static_cast<std::size_t>(i)];
    if (column < 0 && given < 0) continue;
    Eigen::RowVectorXd azimuth, distance;
    if (given >= 0) {
      azimuth = refined.numbers.by_unknown.row(given) * by_unknowns;
      distance = refined.numbers.by_unknown.row(given + 1) * by_unknowns;
    } else {
      azimuth = root.row(column);
      distance = root.row(column + 1);
      facade.determined = d.with_priors[column] && d.with_priors[column + 1];
    }
    // The normal points outward, against the distance, and the upright axis is y.
    facade.deviations.row(0) = -distance - origin.x() * azimuth;
    facade.deviations.row(2) = azimuth;
  }
  return facades;
}

}  // namespace

std::string NameOfUnknown(const Unknown& unknown) {
  if (!unknown.name.empty()) return "`" + unknown.name + "`";
  return unknown.words.empty() ? "a dimension" : "the dimension " + unknown.words;
}

Determined DeterminedOf(std::span<const Photograph> photographs, std::span<const Unknown> unknowns,
                        const Layout& layout, const Refined& refined, const Linearised& at) {
  Determined determined{{}, at.jacobian};
  for (std::size_t i = 0; i < layout.traces.size(); ++i) {
    const TraceRows& rows = layout.traces[i];
    determined.jacobian.middleRows(rows.first_row, rows.rows) *= std::sqrt(refined.weights[i]);
  }
  determined.determination = Determine(determined.jacobian, layout.data_rows(),
                                       QuantitiesOfAll(photographs, unknowns, layout, refined));
  return determined;
}

void AppendWeaknesses(const Photograph& photograph, const Numbers& numbers, const Camera* camera,
                      std::vector<std::string>& warnings) {
  if (camera) WarnOfAngles(*camera, warnings);
  WarnOfVanishingPoints(photograph, numbers, warnings);
}

std::vector<Estimate> EstimatesOf(std::span<const Photograph> photographs,
                                  std::span<const Unknown> unknowns, const Layout& layout,
                                  const Refined& refined, const Linearised& at) {
  const Determined determined = DeterminedOf(photographs, unknowns, layout, refined, at);
  const Determination& d = determined.determination;
  const std::vector<Quantity> quantities = QuantitiesOfAll(photographs, unknowns, layout, refined);
  const std::vector<Shares> shares = SharesOf(layout, determined);
  const Eigen::MatrixXd root = RootOf(d.covariance, layout);
  const auto sigma = [&](int column) {
    return std::sqrt(std::max(0.0, d.covariance(column, column)));
  };
  Estimate common;
  common.photographs = layout.cameras;
  common.chi2 = at.residuals.squaredNorm();
  common.dof = layout.rows() - d.rank;
  common.facades = FacadesOf(photographs, layout, refined, d, root);
  for (int i = 0; i < layout.unknowns; ++i) {
    const int column = layout.unknown_column() + i;
    const bool at_bound = !refined.at_bound.empty() && refined.at_bound[i];
    common.unknowns.push_back({unknowns[i].name, refined.state[column], sigma(column),
                               static_cast<bool>(d.with_priors[column]), at_bound});
    if (!at_bound) continue;
    common.warnings.push_back(fmt::format("`{}` is held at its bound", unknowns[i].name));
  }
  std::vector<Estimate> estimates;
  for (int p = 0; p < layout.cameras; ++p) {
    Estimate estimate = common;
    estimate.camera = CameraAt(refined.state, p);
    if (!d.undetermined.empty()) estimate.undetermined = OpenOf(p, layout, quantities, determined);
    for (int i = 0; i < kParameters; ++i) {
      const int column = kParameters * p + i;
      ParameterEstimate& parameter = estimate.parameters[i];
      parameter.determined = d.by_data[column];
      parameter.from_prior = !d.by_data[column] && d.with_priors[column];
      parameter.sigma = parameter.free() ? std::numeric_limits<double>::quiet_NaN() : sigma(column);
      parameter.shares = shares[column];
    }
    const Eigen::VectorXi columns = ColumnsOf(layout, p);
    estimate.covariance = d.covariance(columns, columns);
    estimate.deviations = root(columns, Eigen::all);
    const bool turned = !estimate.parameters[kOmega].free() && !estimate.parameters[kPhi].free();
    AppendWeaknesses(photographs[p], refined.numbers, turned ? &estimate.camera : nullptr,
                     estimate.warnings);
    for (std::size_t i = 0; i < layout.traces.size(); ++i) {
      const TraceRows& rows = layout.traces[i];
      if (rows.photograph != p) continue;
      const auto r = at.residuals.segment(rows.first_row, rows.rows);
      estimate.residuals.push_back(
          {rows.trace, std::vector<double>(r.begin(), r.end()), refined.weights[i]});
      if (std::holds_alternative<RectangleTrace>(photographs[p].traces[rows.trace])) {
        estimate.rectangles.push_back(
            {rows.trace,
             DotFromRectangle(photographs[p], rows, layout, refined.numbers, refined.state)});
      }
    }
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

}  // namespace tranos::camera
