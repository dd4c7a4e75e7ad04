-- A bar pulled apart and two slabs sheared under pressure, across a joint that softens: the work per crack area is
-- the fracture energy that was put in, whatever the blocks.
--
--   ./cdem run examples/cohesive_bar/case.lua [--set curves=linear] [--set blocks=1,2]
local cdem = require "cdem"

local curves = cdem.parameter{ name = "curves", default = {"linear", "exponential"}, doc = "softening curves" }
local blocks = cdem.parameter{ name = "blocks", default = {1, 2, 4}, range = {1, 16}, doc = "blocks along the joint" }
local increments = cdem.parameter{ name = "increments", default = 40, range = {5, 1000}, doc = "of each loading" }
local pressure = cdem.parameter{ name = "pressure", default = 6e6, range = {0, 1e8}, unit = "Pa", doc = "on the slabs" }

-- Concrete.
local E, nu = 30e9, 0.2
local strength, cohesion, friction_angle = 3e6, 3e6, 35 -- Pa, Pa, deg
local G1, G2 = 100, 200 -- J/m2
local concrete = cdem.elastic{ youngs_modulus = E, poissons_ratio = nu, density = 2400 }
local whole = cdem.mohr_coulomb{ cohesion = 1e12, friction_angle = 0, tensile_strength = 1e12 } -- does not break
local function joint(curve)
  return cdem.mohr_coulomb{ cohesion = cohesion, friction_angle = friction_angle, tensile_strength = strength,
                            softening = curve, fracture_energy_1 = G1, fracture_energy_2 = G2 }
end

-- Remaining fraction of the strength at the fraction xi of the separation, and the separation itself
-- (docs/softening.md).
local a = 5
local function left(curve, xi)
  if xi >= 1 then return 0 end
  return curve == "linear" and 1 - xi or (math.exp(-a * xi) - math.exp(-a)) / (1 - math.exp(-a))
end
local function way(curve, G, peak)
  return G / peak / (curve == "linear" and 0.5 or 1 / a - 1 / (math.exp(a) - 1))
end

local function two_bodies(first, second, curve)
  return cdem.model{ bodies = { { shape = first, material = concrete, joint = whole, name = "first",
                                  element = "small_strain" },
                                { shape = second, material = concrete, joint = whole, name = "second",
                                  element = "small_strain" } },
                     contacts = { { "first", "second", joint(curve) } } }
end

-- Leads a side to `last` (m) in equal increments; returns displacements and mean stresses over the area.
local function lead(model, side, axes, direction, last, area, watch)
  local component = direction[1] ~= 0 and 1 or 2
  local u, stress = {0}, {0}
  for i = 1, increments do
    local d = last * i / increments
    model:fix{ on = side, axes = axes, displacement = {d * direction[1], d * direction[2], 0} }
    model:relax{ residual = 1e-5 }
    u[#u + 1], stress[#stress + 1] = d, model:reaction(side)[component] / area
    if watch then watch(i) end
  end
  return u, stress
end

local figures, opening, slipping, law = {}, {}, {}, {}
local worst_balance = 0
local function add_figure(name, value, reference, source)
  figures[#figures + 1] = { name = name, value = value, reference = reference, unit = "J/m2", kind = "formula",
                            source = source, tolerance = 0.02 }
end
local colours = { {0.00, 0.27, 0.55}, {0.85, 0.33, 0.10}, {0.20, 0.55, 0.25} }
local styles = { linear = "line", exponential = "dashed" }

for c, curve in ipairs(curves) do
  for k, n in ipairs(blocks) do
    local colour = colours[(k - 1) % #colours + 1]
    local name = string.format("%s, %d block%s", curve, n, n > 1 and "s" or "")

    -- Opening: a bar of 0.2 x 0.05 x 0.05 m.
    local half, width = 0.1, 0.05
    local area = width * width
    local bar = two_bodies(cdem.grid{ size = {half, width, width}, divisions = {2 * n, n, 1} },
                           cdem.grid{ size = {half, width, width}, divisions = {2 * n, n, 1}, origin = {half, 0, 0} },
                           curve)
    bar:fix{ on = "x-", axes = "xyz" }
    local crack = 1.1 * way(curve, G1, strength)
    local show = curve == curves[#curves] and n == blocks[#blocks] and math.floor(increments / 6)
    local u, stress = lead(bar, "x+", "xyz", {1, 0}, crack, area, function(i)
      if i == show then
        bar:picture{ file = "bar.png", colour = "stress.xx", deformation = 300, size = {1600, 0},
                     title = "Bar on its softening joint" }
      end
    end)
    opening[#opening + 1] = { name = name, x = u, y = stress, style = styles[curve], colour = colour }
    if k == 1 then
      local w, t, exact_w, exact_t = {}, {}, {}, {}
      for i = 1, #u do
        if stress[i] > 1e-3 * strength then w[#w + 1], t[#t + 1] = u[i] - stress[i] * 2 * half / E, stress[i] end
      end
      for i = 0, 100 do
        exact_w[#exact_w + 1] = way(curve, G1, strength) * i / 100
        exact_t[#exact_t + 1] = strength * left(curve, i / 100)
      end
      law[#law + 1] = { name = curve .. ", law", x = exact_w, y = exact_t, colour = colours[c] }
      law[#law + 1] = { name = curve .. ", bar", x = w, y = t, colour = colours[c], style = "points" }
    end
    add_figure(string.format("opening_%s_%d_J_m2", curve, n), bar:energy().breaking / area, G1, "G_I")
    worst_balance = math.max(worst_balance, bar:energy().balance_error)

    -- Slip: two slabs of 0.1 x 0.02 x 0.05 m on top of each other, pressed.
    local length, height, depth = 0.1, 0.02, 0.05
    local face = length * depth
    local slabs = two_bodies(cdem.grid{ size = {length, height, depth}, divisions = {n, 1, 1} },
                             cdem.grid{ size = {length, height, depth}, divisions = {n, 1, 1}, origin = {0, height, 0} },
                             curve)
    slabs:fix{ on = "y-", axes = "xyz" }
    slabs:fix{ on = "y+", axes = "xz" }
    slabs:traction{ on = "y+", stress = {0, -pressure, 0} }
    slabs:relax{ residual = 1e-6 }
    local elastic = 2 * height * (cohesion + pressure * math.tan(math.rad(friction_angle))) * 2 * (1 + nu) / E
    local d, shear = lead(slabs, "y+", "xz", {1, 0}, 1.1 * way(curve, G2, cohesion) + elastic, face)
    slipping[#slipping + 1] = { name = name, x = d, y = shear, style = styles[curve], colour = colour }
    add_figure(string.format("slip_%s_%d_J_m2", curve, n), slabs:energy().breaking / face, G2, "G_II, beyond friction")
    worst_balance = math.max(worst_balance, slabs:energy().balance_error)
  end
end

local residual_friction = pressure * math.tan(math.rad(friction_angle))
local last = slipping[1].x[#slipping[1].x]
table.insert(slipping, { name = "friction alone", x = {0, last}, y = {residual_friction, residual_friction},
                         style = "dashed", colour = {0.5, 0.5, 0.5} })
cdem.chart{ file = "law.png", title = "Traction over crack opening: the law and the bar's response", series = law,
            x_label = "opening (m)", y_label = "traction (Pa)" }
cdem.chart{ file = "opening.png", title = "Bar pulled apart, G_{I} = " .. G1 .. " J/m^{2}", series = opening,
            x_label = "displacement of the end (m)", y_label = "force / area (Pa)" }
cdem.chart{ file = "slip.png", title = "Slabs sheared under pressure, G_{II} = " .. G2 .. " J/m^{2}", series = slipping,
            x_label = "displacement of the top (m)", y_label = "shear force / area (Pa)" }

figures[#figures + 1] = { name = "energy_balance_error", value = worst_balance, reference = 0, kind = "formula",
                          source = "energy is conserved", tolerance_absolute = 1e-3 }
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
