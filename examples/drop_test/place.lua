-- How a unit stands or hangs before the tests of case.lua, as solids.
local cdem = require "cdem"

local place = {}

local function about_y(solid, angle, centre) return solid:rotate{ axis = {0, 1, 0}, angle = angle, centre = centre } end

-- The unit that stands as built falls towards +x about its lower edge. rolls: its ends are round, so that it has no edge to turn
-- about all the way; then it comes down on its front arm about its rear ones instead, until it stands as built. edge: a point
-- of that; angle: by which it has turned when something else touches the floor, degrees; arm, elevation: of its centre of mass
-- from the edge at that moment, m and radians; mass and inertia about the edge, where the density is 1; at: the solid, turned
-- by an angle.
function place.overturning(unit, size, rolls)
  local lowest = (rolls and unit:mesh{ size = size / 8 } or unit):box().min[3] -- the box of a round solid may be too large
  unit = unit:translate{ shift = {0, 0, -lowest} }
  local low = cdem.solid.box{ size = {10 * size, 10 * size, 0.002 * size}, origin = {-5 * size, -5 * size, -0.001 * size} }
  local sole = cdem.solid.common{ solid = unit, other = low }:box()
  local edge = { rolls and sole.min[1] or sole.max[1], 0, 0 }
  local free, below = 0, rolls and 0 or 180
  for _ = 1, 25 do
    local angle = (free + below) / 2
    if about_y(unit, angle, edge):box().min[3] < -1e-5 * size then below = angle else free = angle end
  end
  local body = about_y(unit, free, edge):inertia{ density = 1 }
  local x, z = body.centroid[1] - edge[1], body.centroid[3]
  local arm = math.sqrt(x * x + z * z)
  return { edge = edge, angle = free, arm = arm, elevation = math.atan(z, x), mass = body.mass,
           inertia = body.tensor[2][2] + body.mass * arm ^ 2,
           at = function(angle) return about_y(unit, angle, edge) end }
end

-- The same of a unit that many times as large.
function place.scale(over, factor)
  over.edge[1], over.arm = over.edge[1] * factor, over.arm * factor
  over.mass, over.inertia = over.mass * factor ^ 3, over.inertia * factor ^ 5
end

-- The angle over that of the touch by which it is turned back where its centre of mass is a height above that of the touch, in
-- degrees; nil beyond balance.
function place.tilt(over, height)
  local sine = math.sin(over.elevation) + height / over.arm
  return sine <= 1 and math.deg(math.asin(sine) - over.elevation) or nil
end

function place.balance_height(over) return over.arm * (1 - math.sin(over.elevation)) end

-- The unit that hangs: its lower side is in front now, at x = -gap.
function place.hanging(unit, gap)
  unit = about_y(unit, -90, {0, 0, 0})
  return unit:translate{ shift = {-gap - unit:box().max[1], 0, 0} }
end

-- The hanging unit, moved on along x until it is about a gap before another.
function place.before(unit, other, gap)
  local volume, apart, inside = unit:volume(), 0, unit:box().max[1] - unit:box().min[1]
  for _ = 1, 14 do
    local middle = (apart + inside) / 2
    local moved = unit:translate{ shift = {middle + gap, 0, 0} }
    local left = cdem.solid.cut{ solid = moved, tools = {other} }
    if left:volume() < (1 - 1e-9) * volume then inside = middle else apart = middle end
  end
  return unit:translate{ shift = {apart, 0, 0} }
end

return place
