// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/camera/cuboid.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace tranos::camera::benchmark {
namespace {

constexpr double kDegree = kPi / 180;

// The second deviate of Box–Muller is not used, so that each draw takes two numbers.
double Normal(std::mt19937_64* random) {
  const auto uniform = [random] {
    return (static_cast<double>((*random)() >> 11) + 0.5) * 0x1p-53;
  };
  const double radius = std::sqrt(-2 * std::log(uniform()));
  return radius * std::cos(2 * kPi * uniform());
}

ParameterVector InRadians(ParameterVector p) {
  p.segment<4>(kSkew) *= kDegree;
  return p;
}

Cuboid Make(const char* name, const ParameterVector& truth, const Vec3& dimensions_m,
            const Vec3& offset_m, const GoldenVertices& golden, const ParameterVector& bound_hi,
            const ParameterVector& bound_lo) {
  return {name,         Camera{InRadians(truth)},
          dimensions_m, offset_m,
          golden,       {InRadians(bound_hi), InRadians(bound_lo)}};
}

ParameterVector Parameters(double f, double r, double u, double v, double alpha, double omega,
                           double phi, double kappa, double x, double y, double z) {
  ParameterVector p;
  p << f, r, u, v, alpha, omega, phi, kappa, x, y, z;
  return p;
}

std::vector<Cuboid> MakeCuboids() {
  const ParameterVector singular = ParameterVector::Zero();
  return {
      Make(
          "B1", Parameters(17.1, 1, 0, 0, 89, -20, 15, 0, 12, -23, 7.0), Vec3(10, 14, 6.0),
          Vec3(-4, -14, -2.5),
          {Vec2(-647.6414511123365, 225.24778234938913),
           Vec2(-753.5312371327701, -63.099471549116664),
           Vec2(-257.7953688471525, -2.378475663031439),
           Vec2(-281.0506723491306, -167.596726962446),
           Vec2(-198.97966253362682, 320.0322273612634),
           Vec2(-243.6085498221748, -15.129144323887799),
           Vec2(5.085611818981516, 23.690663447700302), Vec2(2.35076601626162, -156.3295051748882)},
          Parameters(0.027156532672042107, 0.0006331626008748287, 0.020728635923176985,
                     0.026816432070865117, 0.03038099322024349, 0.07194575747848972,
                     0.05635199198427158, 0.019609682593171557, 0.009811906227913466,
                     0.016758191385683918, 0.005722269214073875),
          Parameters(0.1635836162134659, 0.0038152074448490956, 0.12486979395298459,
                     0.16171052952731615, 0.18316146379318132, 0.4339561778530951,
                     0.3394448266806354, 0.11813999291658445, 0.059124905701268896,
                     0.10096650057124265, 0.034503046882923084)),
      Make("B2", Parameters(35, 1, 0, 0, 89, -10, 10, 0, 20, -15, 6.5), Vec3(10, 14, 6.0),
           Vec3(4, 7, -3.0),
           {Vec2(-716.4705430849294, 309.0855434107294),
            Vec2(-753.2169602851334, -50.28678354892587),
            Vec2(-374.3663327116128, 107.53647654332774),
            Vec2(-388.754993587379, -129.7839204046322),
            Vec2(-129.1815014951544, 350.63188708390084),
            Vec2(-142.0254697973338, -33.61049010889485),
            Vec2(16.353076965749164, 124.90685113489648),
            Vec2(12.429479062489536, -123.02262523867385)},
           Parameters(0.07102326032157757, 0.0003701501571606875, 0.04356254057948802,
                      0.057018769105494575, 0.023626620676068823, 0.08659412107301942,
                      0.06546804586836676, 0.014891806265986482, 0.009539454748489927,
                      0.04636793065678007, 0.0058278387417703085),
           Parameters(0.4274835621105145, 0.0022263159800828157, 0.26201733790214893,
                      0.3429808342027328, 0.1420823574052123, 0.520883520979194, 0.393797861909278,
                      0.08969819712401969, 0.05737858410023677, 0.27904350512773285,
                      0.035089164040454764)),
      Make("B3", Parameters(35, 1, 0, 0, 90, 20, 30, 0, 10, -30, 2.0), Vec3(10, 14, 6.0),
           Vec3(-6, -19, 4.5),
           {Vec2(-750.3220971933529, 327.2944995288975),
            Vec2(-670.8571429520861, -160.0029392033246),
            Vec2(-73.47307928482417, 422.06642896481446),
            Vec2(-68.57293846504793, 108.88137607249486),
            Vec2(37.43508860716849, 238.39982281196507),
            Vec2(32.201323595822736, -392.4541652921091),
            Vec2(473.0216680100444, 393.87661481961186),
            Vec2(435.78909095302663, 26.46927864647416)},
           Parameters(0.018577785181083495, 0.00015648261065415089, 0.026608195783223314,
                      0.026670160744087953, 0.00936361055564984, 0.0380474916192498,
                      0.032470179908423914, 0.006881844348654051, 0.0042239534157158245,
                      0.009376434973641212, 0.00200884316627956),
           Parameters(0.11184776045307646, 0.0009420184494032705, 0.16023188789178747,
                      0.1605271594768417, 0.056395862354084315, 0.22896789491644767,
                      0.19552928283320764, 0.04143634647383903, 0.02543178059885062,
                      0.056460150384600484, 0.012090633301836077)),
      Make("B4", Parameters(33.33, 1.03, 0, 0, 89.07, 15.96, 35.28, 1.52, 14.79, -27.73, -1.78),
           Vec3(15.5, 35.5, 12.0), Vec3(-11, -15, -3.0),
           {Vec2(-851.6832755993919, 493.7933145853899),
            Vec2(-742.2056391715436, -211.0736029586715),
            Vec2(189.67227169104294, 478.8471739556845),
            Vec2(181.51430742605552, 131.05345377776183),
            Vec2(-106.59846236640391, 559.3629000617051),
            Vec2(-78.33108826890142, -482.057522941145), Vec2(661.8867972058358, 499.1826547442522),
            Vec2(618.7354765132793, 85.6144442461413)},
           Parameters(0.008642940523749355, 0.00015888031775139645, 0.015571510887190713,
                      0.015121059021370602, 0.007240858747106069, 0.022864680387983397,
                      0.018030240156162267, 0.00349796939761272, 0.004398774227955116,
                      0.006846398766625296, 0.0016038361230757288),
           Parameters(0.052002886808157, 0.000956120678221124, 0.09369775300880764,
                      0.09102294708981992, 0.04358387293881235, 0.13764023956791469,
                      0.10848900740762271, 0.021023768191869185, 0.026472244013357567,
                      0.0411965763534482, 0.009639961110451394)),
      Make("L1", Parameters(17.1, 1, 0, 0, 89, -20, 15, 0, 12, -23, 7.0), Vec3(10, 14, 6.0),
           Vec3(0, 0, 0.0),
           {Vec2(-164.6757019608863, -60.442925438534054),
            Vec2(-181.77512703717164, -243.10973251385667),
            Vec2(-41.65504227226445, -131.06664416595046),
            Vec2(-46.00511579159087, -254.6663132641384),
            Vec2(127.96464117561476, -38.312288308898985),
            Vec2(136.61723757326425, -239.35509856669697),
            Vec2(157.2089130796701, -121.35871800653689),
            Vec2(164.41030227141403, -253.11491523026777)},
           Parameters(0.1923418217770222, 0.0012041534332924919, 0.12268141751454904,
                      0.16960320403474036, 0.12711526899245276, 0.3692345426077386,
                      0.292307575347885, 0.03007593611191186, 0.018009113680533664,
                      0.3316141106679785, 0.01051544584393271),
           Parameters(1.1652277967817304, 0.007280280229134769, 0.7426735881499783,
                      1.0267458407643884, 0.7698995567582436, 2.2333658101316334,
                      1.7682829139129526, 0.18153992076883088, 0.10914701656132447,
                      2.0088943519313864, 0.06350817165751929)),
      Make("L2", Parameters(35, 1, 0, 0, 89, -10, 10, 0, 20, -15, 6.5), Vec3(10, 14, 6.0),
           Vec3(0, 0, 0.0),
           {Vec2(-1387.6226989907493, 263.35307783150057),
            Vec2(-1476.5849101192605, -230.54293650256946),
            Vec2(-697.2487137370057, 39.937357140214495),
            Vec2(-725.2861056735394, -249.31922743309087),
            Vec2(-642.5366716005507, 316.2341769645785),
            Vec2(-693.3112304780923, -225.96615494227694),
            Vec2(-240.75437497848162, 57.29131992909144),
            Vec2(-254.49917250196145, -247.89232626102103)},
           Parameters(0.030394190861959918, 0.00033357579722310856, 0.019477451941137265,
                      0.02782028098581723, 0.025609825408783513, 0.042300122598547964,
                      0.025941238141781075, 0.004353933103670529, 0.008087582727920711,
                      0.014965047402337216, 0.0015897071919928243),
           Parameters(0.18290160493273316, 0.00200783084280505, 0.11724144141246769,
                      0.16748302950717342, 0.1541737587164233, 0.25466812178121545,
                      0.15615030266740254, 0.02621243795682777, 0.048674737753630924,
                      0.09005411141596797, 0.009569054357705276)),
      Make("L3", Parameters(35, 1, 0, 0, 90, 20, 30, 0, 10, -30, 2.0), Vec3(10, 14, 6.0),
           Vec3(0, 0, 0.0),
           {Vec2(346.90110126411616, 682.6362461140625),
            Vec2(323.54572353948265, 348.93682589510706),
            Vec2(521.0930051389771, 649.3162728721359), Vec2(495.5555600179804, 408.04420936763614),
            Vec2(983.2887207683709, 705.6951200453782), Vec2(905.0237904583388, 309.34759960493847),
            Vec2(974.3520203058639, 660.4380802038754), Vec2(920.5664519870772, 388.0584006438915)},
           singular, singular),
  };
}

}  // namespace

const std::vector<Cuboid>& Cuboids() {
  static const std::vector<Cuboid> cuboids = MakeCuboids();
  return cuboids;
}

const Cuboid& CuboidOf(std::string_view name) {
  return *std::find_if(Cuboids().begin(), Cuboids().end(),
                       [name](const Cuboid& c) { return c.name == name; });
}

Frame FrameOf(Picture picture) {
  const Eigen::Vector2i size =
      picture == kHi ? Eigen::Vector2i(1600, 1067) : Eigen::Vector2i(484, 319);
  const double pitch_mm = picture == kHi ? 0.0225 : 0.0743801652892562;
  return {pitch_mm * size.cast<double>(), size};
}

Vec3 Vertex(int index, const Vec3& dimensions_m, const Vec3& offset_m) {
  return offset_m + Vec3(index >> 2 & 1, index >> 1 & 1, index & 1).cwiseProduct(dimensions_m);
}

std::vector<CuboidEdge> VisibleEdges(const Cuboid& cuboid) {
  const Vec3 camera = cuboid.truth.position_m() - cuboid.offset_m;
  bool seen[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    seen[axis][0] = camera[axis] < 0;
    seen[axis][1] = camera[axis] > cuboid.dimensions_m[axis];
  }
  std::vector<CuboidEdge> edges;
  for (int axis = 0; axis < 3; ++axis)
    for (int from = 0; from < 8; ++from) {
      const int step = 4 >> axis;
      if (from & step) continue;
      bool visible = false;
      for (int other = 0; other < 3; ++other)
        if (other != axis) visible |= seen[other][from >> (2 - other) & 1];
      if (visible) edges.push_back({from, from + step, axis});
    }
  return edges;
}

double SamplesOf(double length_px) { return std::max(2.0, std::floor(length_px)); }

Segment ExactSegment(const Cuboid& cuboid, const CuboidEdge& edge, const Frame& frame) {
  const auto dot = [&](int index) {
    const Vec3 vertex = Vertex(index, cuboid.dimensions_m, cuboid.offset_m);
    return frame.DotFromPoint(Project(cuboid.truth, vertex).point_mm);
  };
  return {dot(edge.from), dot(edge.to)};
}

TracedCuboid TraceCuboid(const Cuboid& cuboid, const Tracing& tracing) {
  TracedCuboid result;
  std::mt19937_64 random(tracing.seed);
  Photograph& photograph = result.photograph;
  photograph.name = cuboid.name;
  photograph.frame = FrameOf(tracing.picture);
  const double declared = tracing.sigma_px > 0 ? tracing.sigma_px : 0.5;
  for (const CuboidEdge& edge : VisibleEdges(cuboid)) {
    auto [a, b] = ExactSegment(cuboid, edge, photograph.frame);
    const double samples = SamplesOf((b - a).norm());
    const Vec2 along = (b - a).normalized();
    const Vec2 across(-along.y(), along.x());
    const double centre = tracing.sigma_px / std::sqrt(samples) * Normal(&random);
    const double tilt = tracing.sigma_px * std::sqrt(12 / samples) * Normal(&random);
    a += (centre - tilt / 2) * across;
    b += (centre + tilt / 2) * across;
    const ImageLine line{a, b, declared / std::sqrt(samples), declared * std::sqrt(12 / samples)};
    if (tracing.edges) photograph.traces.push_back(EdgeTrace{line, 3 * edge.from, 3 * edge.to});
    if (tracing.directions) photograph.traces.push_back(DirectionTrace{line, edge.axis});
  }
  const Vec3 relative(Normal(&random), Normal(&random), Normal(&random));
  result.dimensions_m =
      cuboid.dimensions_m + tracing.dimension_sigma * cuboid.dimensions_m.cwiseProduct(relative);
  for (int axis = 0; axis < 3; ++axis)
    result.unknowns.push_back({std::string(1, static_cast<char>('X' + axis)),
                               result.dimensions_m[axis],
                               tracing.dimension_sigma * cuboid.dimensions_m[axis]});
  const int columns = tracing.dimension_sigma > 0 ? 3 : 0;
  if (columns == 0) result.unknowns.clear();
  result.numbers = NumbersOf(cuboid, result.dimensions_m, columns);
  return result;
}

Numbers NumbersOf(const Cuboid& cuboid, const Vec3& dimensions_m, int unknowns) {
  Numbers numbers{Eigen::VectorXd(24), Eigen::MatrixXd::Zero(24, unknowns)};
  for (int index = 0; index < 8; ++index) {
    numbers.values.segment<3>(3 * index) = Vertex(index, dimensions_m, cuboid.offset_m);
    for (int axis = 0; axis < unknowns; ++axis)
      numbers.by_unknown(3 * index + axis, axis) = index >> (2 - axis) & 1;
  }
  return numbers;
}

TracedCuboid TracePoints(const Cuboid& cuboid, const std::vector<int>& vertices) {
  TracedCuboid traced;
  traced.photograph.frame = FrameOf(kHi);
  traced.numbers = NumbersOf(cuboid, cuboid.dimensions_m, 0);
  for (const int index : vertices) {
    const Vec3 vertex = Vertex(index, cuboid.dimensions_m, cuboid.offset_m);
    const Vec2 dot = traced.photograph.frame.DotFromPoint(Project(cuboid.truth, vertex).point_mm);
    traced.photograph.traces.push_back(PointTrace{dot, 0.5, 3 * index});
  }
  return traced;
}

}  // namespace tranos::camera::benchmark
