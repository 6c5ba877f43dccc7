#include "raybound/trace/cell_trials.h"

#include <algorithm>
#include <chrono>
#include <random>

#include "raybound/numbers/taylor_powers.h"
#include "raybound/numbers/taylor_views.h"

namespace raybound {

namespace {

using Generator = std::mt19937_64;

double uniform(Generator& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}
double power_of_ten(Generator& random, double low, double high) { return std::pow(10.0, uniform(random, low, high)); }
Vec3d direction(Generator& random) {
    Vec3d v;
    do v = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    while (dot(v, v) > 1 || dot(v, v) < 0.01);
    return normalize(v);
}

struct Setting {
    CellScene scene;
    Vec3d target, normal;  // where the middle ray meets the first surface
    double size;
};

Material random_material(Generator& random) {
    Material material;
    const auto part = [&] { return float(uniform(random, 0.1, 0.9)); };
    material.diffuse = {part(), part(), part()};
    material.specular = {part(), part(), part()};
    material.roughness = float(power_of_ten(random, -1, 0));
    return material;
}

// A sphere or a plane, and a light in front of it; every fourth time the surface is a mirror before a plane.
Setting random_setting(Generator& random) {
    Setting setting;
    const double size = setting.size = power_of_ten(random, -2, 2);
    const Vec3d center = direction(random) * (size * power_of_ten(random, -1, 5)), normal = direction(random);
    CellSurface surface;
    surface.kind = uniform(random, 0, 1) < 0.6 ? SurfaceKind::sphere : SurfaceKind::plane;
    surface.center = Vec3f(center);
    surface.normal = Vec3f(normal);
    surface.radius = float(size);
    surface.material = random_material(random);
    setting.normal = normal;
    setting.target = center + normal * (surface.kind == SurfaceKind::sphere ? size : 0.0);
    setting.scene.ambient = {0.1f, 0.2f, 0.3f};
    Light& light = setting.scene.light;
    light.intensity = {1.0f, 0.7f, 2.0f};
    light.kind = uniform(random, 0, 1) < 0.3 ? LightKind::directional : LightKind::point;
    light.falloff = uniform(random, 0, 1) < 0.3;
    const Vec3d toward = normalize(normal + direction(random) * 0.8);
    light.direction = -toward;
    light.position = Vec3f(setting.target + toward * (size * power_of_ten(random, 0, 2)));
    setting.scene.surfaces.push_back(surface);
    return setting;
}

// A wall that faces the rays which a mirror sends on; the light is moved to its front.
void add_wall(Generator& random, Setting& setting, const Vec3d& incoming) {
    setting.scene.surfaces[0].is_mirror = true;
    const Vec3d outgoing = reflected_direction(incoming, setting.normal);
    CellSurface wall = setting.scene.surfaces[0];
    wall.kind = SurfaceKind::plane;
    wall.is_mirror = false;
    const Vec3d at = setting.target + outgoing * (setting.size * power_of_ten(random, -1, 1));
    wall.center = Vec3f(at);
    wall.normal = Vec3f(normalize(direction(random) * 0.5 - outgoing));
    setting.scene.light.position = Vec3f(at - outgoing * setting.size);
    setting.scene.light.direction = outgoing;
    setting.scene.surfaces.push_back(wall);
}

// The eye's rays around one that meets the target at `cosine` to the normal.
struct View {
    Vec3d eye, forward, right, up;
};
View random_view(Generator& random, const Setting& setting, double cosine) {
    const auto [a, b] = orthonormal_basis(setting.normal);
    const double angle = uniform(random, 0, 6.28), sine = std::sqrt(1 - cosine * cosine);
    const Vec3d back = setting.normal * cosine + (a * std::cos(angle) + b * std::sin(angle)) * sine;
    const auto [right, up] = orthonormal_basis(back);
    return {setting.target + back * (setting.size * power_of_ten(random, -0.5, 3)), -back, right, up};
}

// N = 2: the pixels of a block; N = 4: the eye moves as well, on a plane before the target.
template <int N>
RayFamily<N> random_family(Generator& random, const Setting& setting, const View& view) {
    RayFamily<N> family;
    const Vec3d way = setting.target - view.eye;
    const double reach = length(way), h = setting.size * power_of_ten(random, -5, -1);
    family.origin = view.eye;
    family.direction = way * (1 / reach);
    const double across = h / reach;
    family.direction_slopes[0] = view.right * across;
    family.direction_slopes[1] = view.up * across;
    if constexpr (N == 4) {
        const double shift = uniform(random, 0.1, 1) * std::min(h, 0.05 * reach);
        family.origin_slopes[2] = view.right * shift;
        family.origin_slopes[3] = view.up * shift;
        family.direction_slopes[2] = view.right * (-shift / reach);
        family.direction_slopes[3] = view.up * (-shift / reach);
    }
    return family;
}

template <class T, int N>
Vec3<T> radiance(const CellScene& scene, const RayFamily<N>& family, const std::array<Wide<T>, std::size_t(N)>& x) {
    return cell_radiance<T>(scene, family_ray<T, N>(family, x));
}

template <int N>
using Executed = TaylorModel<N, Arithmetic::float32>;

template <int N>
Vec3<Executed<N>> over_cell(const CellScene& scene, const RayFamily<N>& family) {
    std::array<Wide<Executed<N>>, std::size_t(N)> x;
    for (int i = 0; i < N; ++i) x[std::size_t(i)] = Wide<Executed<N>>::variable(i, 0, 1);
    return radiance<Executed<N>, N>(scene, family, x);
}

// Inside, at the corners, and on the edges of the cell.
template <int N>
std::array<double, std::size_t(N)> random_point(Generator& random) {
    std::array<double, std::size_t(N)> x;
    const bool edge = uniform(random, 0, 1) < 0.3;
    for (double& v : x) {
        v = uniform(random, -1, 1);
        if (edge && std::abs(v) > 0.3) v = std::copysign(1.0, v);
    }
    return x;
}

template <int N>
void try_point(const Setting& setting, const RayFamily<N>& family, const Vec3<Executed<N>>& bounds,
               const std::array<double, std::size_t(N)>& x, CellTrials& trials) {
    const Vec3f single = radiance<float, N>(setting.scene, family, x);
    const Vec3d wide = radiance<double, N>(setting.scene, family, x);
    for (int channel = 0; channel < 3; ++channel) {
        const Executed<N>& f = bounds[channel];
        const Interval<double> value = value_at(f, x.data());
        const double middle = value.mid(), off = std::abs(double(single[channel]) - middle);
        if (!value.contains(double(single[channel]))) ++trials.float_outside;
        if (!value.contains(wide[channel])) ++trials.double_outside;
        trials.largest_share = std::max(trials.largest_share, off / f.remainder());
    }
    ++trials.points;
}

template <int N>
CellTrials run(std::int64_t cells, std::int64_t points, std::uint64_t seed) {
    Generator random(seed);
    CellTrials trials;
    for (; trials.cells < cells; ++trials.cells) {
        Setting setting = random_setting(random);
        const double cosine = uniform(random, 0, 1) < 0.3 ? power_of_ten(random, -3, -1) : uniform(random, 0.1, 1);
        const View view = random_view(random, setting, cosine);
        if (uniform(random, 0, 1) < 0.25) add_wall(random, setting, view.forward);
        const RayFamily<N> family = random_family<N>(random, setting, view);
        const Vec3<Executed<N>> bounds = over_cell(setting.scene, family);
        if (!bounds.x.is_known() || !bounds.y.is_known() || !bounds.z.is_known()) continue;
        ++trials.bounded;
        trials.far += length(setting.target) > 1000 * setting.size;
        trials.grazing += cosine < 0.1;
        trials.widest = std::max(trials.widest, bounds.x.remainder() / bounds.x.known());
        for (std::int64_t i = 0; i < points; ++i) try_point(setting, family, bounds, random_point<N>(random), trials);
    }
    return trials;
}

template <class Function>
double nanoseconds(int evaluations, Function f) {
    const auto start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / evaluations;
}

// The unit sphere under a point light, with diffuse and specular reflection.
CellScene timed_scene() {
    CellScene scene;
    scene.surfaces.resize(1);
    scene.surfaces[0].material.specular = {0.3f, 0.3f, 0.3f};
    scene.light.position = {2, 1.5f, 4};
    scene.light.intensity = {1, 1, 1};
    scene.ambient = {0.1f, 0.1f, 0.1f};
    return scene;
}

template <int N>
RayFamily<N> timed_family(Generator& random) {
    RayFamily<N> family;
    const auto place = [&] { return uniform(random, -0.4, 0.4); };
    family.origin = {N == 4 ? place() : 0.0, N == 4 ? place() : 0.0, N == 4 ? 1.5 : 5.0};
    family.direction = Vec3d{place(), place(), 0} * (N == 4 ? 1.0 : 0.3) - Vec3d{0, 0, N == 4 ? 2.0 : 1.0};
    const double h = N == 4 ? 0.01 : 0.002;
    family.direction_slopes[0] = {h, 0, 0};
    family.direction_slopes[1] = {0, h, 0};
    if constexpr (N == 4) {
        family.origin_slopes[2] = {h, 0, 0};
        family.origin_slopes[3] = {0, h, 0};
        family.direction_slopes[2] = {-h, 0, 0};
        family.direction_slopes[3] = {0, -h, 0};
    }
    return family;
}

template <int N>
CellTimes time(int rounds) {
    Generator random(1);
    const CellScene scene = timed_scene();
    std::vector<RayFamily<N>> families;
    for (int i = 0; i < 1000; ++i) families.push_back(timed_family<N>(random));
    CellTimes best{infinity<double>, infinity<double>};
    volatile double sink = 0;
    for (int round = 0; round < rounds; ++round) {
        best.plain = std::min(best.plain, nanoseconds(1000, [&] {
                                  std::array<double, std::size_t(N)> x;
                                  x.fill(0.3);
                                  for (const auto& family : families)
                                      sink = sink + radiance<double, N>(scene, family, x).x;
                              }));
        best.taylor = std::min(best.taylor, nanoseconds(1000, [&] {
                                   for (const auto& family : families)
                                       sink = sink + over_cell(scene, family).x.remainder();
                               }));
    }
    return best;
}

}  // namespace

CellTrials run_cell_trials(int n, std::int64_t cells, std::int64_t points, std::uint64_t seed) {
    return n == 2 ? run<2>(cells, points, seed) : run<4>(cells, points, seed);
}

CellTimes time_cells(int n, int rounds) { return n == 2 ? time<2>(rounds) : time<4>(rounds); }

}  // namespace raybound
