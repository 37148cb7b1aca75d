// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/refinement.h"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <Eigen/QR>
#include <algorithm>
#include <memory>

namespace tranos::camera {

namespace {

// All residuals and derivatives at the point that Ceres asks about, made once for all blocks.
class Evaluation final : public ceres::EvaluationCallback {
 public:
  Evaluation(std::span<const Photograph> photographs, std::span<const Unknown> unknowns,
             const Layout& layout, const NumbersOfUnknowns& numbers_of, double noise_scale,
             const Eigen::VectorXd& state)
      : photographs_(photographs),
        unknowns_(unknowns),
        layout_(layout),
        numbers_of_(numbers_of),
        noise_scale_(noise_scale),
        state_(state) {}

  void PrepareForEvaluation(bool /*derivatives*/, bool /*is_new*/) override { Update(); }

  void Update() {
    if (at_.size() == state_.size() && at_ == state_) return;
    const Eigen::VectorXd u = state_.segment(layout_.unknown_column(), layout_.unknowns);
    if (at_.size() == 0 || u != at_.segment(layout_.unknown_column(), layout_.unknowns)) {
      numbers_ = CallWithoutExceptions(u);
    }
    at_ = state_;
    linearised_ = numbers_
                      ? Linearise(photographs_, unknowns_, layout_, *numbers_, at_, noise_scale_)
                      : tl::unexpected(numbers_.error());
  }

  const geom::Result<Linearised>& linearised() const { return linearised_; }
  const geom::Result<Numbers>& numbers() const { return numbers_; }

 private:
  geom::Result<Numbers> CallWithoutExceptions(const Eigen::VectorXd& u) const {
    try {
      return numbers_of_(u);
    } catch (const std::exception& e) {
      return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, e.what()});
    }
  }

  std::span<const Photograph> photographs_;
  std::span<const Unknown> unknowns_;
  const Layout& layout_;
  const NumbersOfUnknowns& numbers_of_;
  double noise_scale_;
  const Eigen::VectorXd& state_;
  Eigen::VectorXd at_;
  geom::Result<Numbers> numbers_;
  geom::Result<Linearised> linearised_;
};

struct StateBlock {
  int column;
  int size;
};

// Some rows of the evaluation, by some blocks of the state.
class Rows final : public ceres::CostFunction {
 public:
  Rows(const Evaluation& evaluation, int first_row, int rows, std::vector<StateBlock> blocks)
      : evaluation_(evaluation), first_row_(first_row), blocks_(std::move(blocks)) {
    set_num_residuals(rows);
    for (const StateBlock& block : blocks_) mutable_parameter_block_sizes()->push_back(block.size);
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    const geom::Result<Linearised>& at = evaluation_.linearised();
    if (!at) return false;
    const int rows = num_residuals();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = at->residuals.segment(first_row_, rows);
    if (!jacobians) return true;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (!jacobians[i]) continue;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> to(
          jacobians[i], rows, blocks_[i].size);
      to = at->jacobian.block(first_row_, blocks_[i].column, rows, blocks_[i].size);
    }
    return true;
  }

 private:
  const Evaluation& evaluation_;
  int first_row_;
  std::vector<StateBlock> blocks_;
};

std::unique_ptr<ceres::LossFunction> LossOf(Loss loss, int residuals) {
  // The loss sees the length of all of a trace's residuals, which grows with their number.
  const double size = std::sqrt(static_cast<double>(residuals));
  switch (loss) {
    case Loss::kNone:
      return nullptr;
    case Loss::kHuber:
      return std::make_unique<ceres::HuberLoss>(1.345 * size);
    case Loss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(2.385 * size);
  }
  return nullptr;
}

void SilenceLogging() {
  // Ceres tells of failed steps by glog, on standard error; here they are told by results.
  FLAGS_minloglevel = google::GLOG_FATAL;
}

ceres::Solver::Options Options(bool is_rough) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = 300;
  options.max_num_consecutive_invalid_steps = 50;
  options.initial_trust_region_radius = 1e6;
  options.function_tolerance = 1e-15;
  options.parameter_tolerance = 1e-13;
  options.gradient_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  if (!is_rough) return options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-4;
  options.max_num_iterations = 60;
  return options;
}

// Blocks of the state as Ceres has them: a camera each, the unknowns, the nuisances.
std::vector<StateBlock> BlocksOf(const Layout& layout, int photograph) {
  std::vector<StateBlock> blocks;
  if (photograph >= 0) blocks.push_back({kParameters * photograph, kParameters});
  if (layout.unknowns > 0) blocks.push_back({layout.unknown_column(), layout.unknowns});
  const int nuisances = layout.columns - layout.nuisance_column();
  if (photograph >= 0 && nuisances > 0) blocks.push_back({layout.nuisance_column(), nuisances});
  return blocks;
}

// Gauss–Newton to the last bits, where Ceres's tests of progress drown in rounding.
void Polish(Evaluation& evaluation, Eigen::VectorXd& state, const Layout& layout,
            const std::optional<double>& skew_rad) {
  constexpr int kSteps = 12;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::VectorXd before = state;
    Eigen::MatrixXd j = evaluation.linearised()->jacobian;
    const Eigen::VectorXd r = evaluation.linearised()->residuals;
    if (skew_rad) j.col(kSkew).setZero();
    const Eigen::VectorXd scale = j.colwise().norm().cwiseMax(1e-12);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(j * scale.cwiseInverse().asDiagonal());
    qr.setThreshold(1e-10);
    if (qr.rank() < layout.columns - (skew_rad ? 1 : 0)) return;
    const Eigen::VectorXd step = -qr.solve(r);
    if (!step.allFinite() || step.norm() > 1e-2 * std::sqrt(1.0 * layout.columns)) return;
    state += step.cwiseQuotient(scale);
    evaluation.Update();
    const bool worse =
        !evaluation.linearised() ||
        evaluation.linearised()->residuals.squaredNorm() > r.squaredNorm() * (1 + 1e-12) + 1e-20;
    if (worse) {
      state = before;
      evaluation.Update();
      return;
    }
    if (step.norm() < 1e-10) return;
  }
}

geom::Result<Refined> Solve(std::span<const Photograph> photographs,
                            std::span<const Unknown> unknowns, const Layout& layout,
                            const NumbersOfUnknowns& numbers_of, const Eigen::VectorXd& start,
                            const RefineOptions& refine) {
  Refined refined;
  refined.state = start;
  Eigen::VectorXd& state = refined.state;
  if (refine.skew_rad) state[kSkew] = *refine.skew_rad;
  for (int i = 0; i < layout.unknowns; ++i) {
    double& value = state[layout.unknown_column() + i];
    value = std::clamp(value, unknowns[i].min, unknowns[i].max);
  }
  Evaluation evaluation(photographs, unknowns, layout, numbers_of, refine.noise_scale, state);
  evaluation.Update();
  if (!evaluation.linearised()) return tl::unexpected(evaluation.linearised().error());

  ceres::Problem::Options ownership;
  ownership.evaluation_callback = &evaluation;
  ownership.disable_all_safety_checks = true;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  std::vector<std::unique_ptr<ceres::LossFunction>> losses;
  const auto add = [&](int first_row, int rows, int photograph, ceres::LossFunction* loss) {
    if (rows == 0) return;
    const std::vector<StateBlock> blocks = BlocksOf(layout, photograph);
    std::vector<double*> at;
    for (const StateBlock& block : blocks) at.push_back(state.data() + block.column);
    problem.AddResidualBlock(new Rows(evaluation, first_row, rows, blocks), loss, at);
  };
  for (const TraceRows& rows : layout.traces) {
    losses.push_back(LossOf(refine.loss, rows.rows));
    add(rows.first_row, rows.rows, rows.photograph, losses.back().get());
  }
  add(layout.trace_rows, layout.unknown_prior_rows, -1, nullptr);
  int row = layout.data_rows();
  for (int p = 0; p < layout.cameras; ++p) {
    const auto priors = static_cast<int>(std::ranges::count_if(
        photographs[p].priors, [](const Prior& prior) { return prior.sigma > 0; }));
    add(row, priors, p, nullptr);
    row += priors;
  }
  if (refine.skew_rad && problem.HasParameterBlock(state.data())) {
    problem.SetManifold(state.data(), new ceres::SubsetManifold(kParameters, {kSkew}));
  }
  double* const first_unknown = state.data() + layout.unknown_column();
  if (layout.unknowns > 0 && problem.HasParameterBlock(first_unknown)) {
    for (int i = 0; i < layout.unknowns; ++i) {
      if (std::isfinite(unknowns[i].min))
        problem.SetParameterLowerBound(first_unknown, i, unknowns[i].min);
      if (std::isfinite(unknowns[i].max))
        problem.SetParameterUpperBound(first_unknown, i, unknowns[i].max);
    }
  }
  ceres::Solver::Summary summary;
  ceres::Solver::Options solver = Options(refine.is_rough);
  // Polishing goes on from there in fewer evaluations.
  if (refine.loss == Loss::kNone && !refine.is_rough) solver.function_tolerance = 1e-12;
  ceres::Solve(solver, &problem, &summary);
  refined.converged = summary.termination_type == ceres::CONVERGENCE;

  evaluation.Update();
  if (!evaluation.linearised()) return tl::unexpected(evaluation.linearised().error());
  for (int i = 0; i < layout.unknowns; ++i) {
    const double value = first_unknown[i], reach = 1e-9 * (std::abs(value) + 1);
    refined.at_bound.push_back(value <= unknowns[i].min + reach ||
                               value >= unknowns[i].max - reach);
  }
  const bool bound = std::ranges::find(refined.at_bound, true) != refined.at_bound.end();
  const bool wants_polish = refine.loss == Loss::kNone && !bound && !refine.is_rough;
  if (wants_polish) Polish(evaluation, state, layout, refine.skew_rad);
  // What gives the numbers may have come to its limit in the meantime.
  if (!evaluation.linearised()) return tl::unexpected(evaluation.linearised().error());
  const Linearised& at = *evaluation.linearised();
  refined.numbers = *evaluation.numbers();
  refined.chi2 = at.residuals.squaredNorm();
  refined.cost = at.residuals.tail(layout.rows() - layout.trace_rows).squaredNorm();
  for (std::size_t i = 0; i < layout.traces.size(); ++i) {
    const TraceRows& rows = layout.traces[i];
    const double squared = at.residuals.segment(rows.first_row, rows.rows).squaredNorm();
    double rho[3] = {squared, 1, 0};
    if (losses[i]) losses[i]->Evaluate(squared, rho);
    refined.cost += rho[0];
    refined.weights.push_back(rho[1]);
  }
  return refined;
}

}  // namespace

geom::Result<Refined> Refine(std::span<const Photograph> photographs,
                             std::span<const Unknown> unknowns, const Layout& layout,
                             const NumbersOfUnknowns& numbers_of, const Eigen::VectorXd& start,
                             const RefineOptions& options) {
  SilenceLogging();
  try {
    return Solve(photographs, unknowns, layout, numbers_of, start, options);
  } catch (const std::exception& e) {
    return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, e.what()});
  }
}

}  // namespace tranos::camera
