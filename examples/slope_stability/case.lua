-- A homogeneous slope of soil to its factor of safety: Griffiths and Lane 1999 (Geotechnique 49, 387-403), example 1.
-- 26.57 degrees steep, no foundation, phi = 20 degrees, c / (gamma H) = 0.05, no dilation: F = 1.4 by finite elements,
-- 1.38 by Bishop and Morgenstern's charts.
--
--   ./cdem run examples/slope_stability/case.lua [--set zones=20]
local cdem = require "cdem"

local zones = cdem.parameter{ name = "zones", default = 14, range = {3, 60}, doc = "over the height of the slope" }
local dilation = cdem.parameter{ name = "dilation_angle", default = 0, range = {0, 20}, unit = "degrees" }
local tolerance = cdem.parameter{ name = "tolerance", default = 0.03, range = {0.001, 0.2}, doc = "width of the bracket" }
local H, g = 10, 9.81 -- m, m/s2

-- A slab one zone thick between smooth walls: plane strain.
local size = H / zones
local corners = {}
for _, y in ipairs{ 0, size } do
  for _, p in ipairs{ {0, 0}, {3.2 * H, 0}, {1.2 * H, H}, {0, H} } do corners[#corners + 1] = { p[1], y, p[2] } end
end
local soil = cdem.elastic{ youngs_modulus = 1e8, poissons_ratio = 0.3, density = 2000 }
local strength = cdem.plastic{ cohesion = 0.05 * soil.density * g * H, friction_angle = 20, dilation_angle = dilation,
                               tensile_strength = 1e9 } -- up to the tip of the cone
local model = cdem.model{ bodies = { { name = "slope", shape = cdem.convex_hull{ points = corners }, material = soil,
                                       plasticity = strength, zone_size = size } } }
model:fix{ on = "z-" }
model:fix{ on = "x-", axes = "x" }
model:fix{ on = {"y-", "y+"}, axes = "y" }
model:gravity{ vector = {0, 0, -g} }
model:relax{ residual = 1e-4 }

local safety = cdem.factor_of_safety{ model = model, reduce = {"blocks"}, lower = 1.3, upper = 1.6, residual = 1e-4,
                                      tolerance = tolerance, picture = "mechanism.png" }
cdem.report{ { name = "factor_of_safety", value = safety.factor, reference = 1.4, kind = "paper", tolerance = 0.04,
               source = "Griffiths and Lane 1999, example 1" },
             { name = "tetrahedra", value = model:counts().tets },
             { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } }
