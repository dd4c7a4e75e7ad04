-- The unit of Feng 2014 section 3 and its six set-ups, for the scripts of this example.
local unit = {}

-- Table 1 of the paper.
unit.density, unit.youngs_modulus, unit.poissons_ratio = 2500, 30e9, 0.25
unit.tensile_strength, unit.cohesion, unit.friction_angle = 3e6, 6e6, 45

-- The held side and the direction of the flow are our interpretation: the paper draws them in its Fig 3 without axes.
-- place: where the paper says the unit breaks.
unit.cases = {
  { held = "z-", flow = {1, 0, 0}, velocity = 23.66, place = "root" },
  { held = "z-", flow = {0, 1, 0}, velocity = 20.78, place = "top" },
  { held = "x-", flow = {0, 1, 0}, velocity = 22.44, place = "root" },
  { held = "x-", flow = {0, 0, 1}, velocity = 21.71, place = "left and right of the waist" },
  { held = "y-", flow = {1, 0, 0}, velocity = 24.17, place = "root" },
  { held = "y-", flow = {0, 0, 1}, velocity = 24.50, place = "root and waist" },
}

-- First break of set-up 1 by beam theory, stocky shape, m/s: the flow meets 2.47 m2 of the 5 t unit, on average at half
-- its height of 1.81 m; both legs, chamfered, have W = 0.064 m3 at the root. No size counts.
function unit.beam_velocity(tensile_strength)
  local pressure = tensile_strength * 0.064 / (2.47 * 1.81 / 2)
  return math.sqrt(2 * pressure / 1025)
end

local axis_of = { x = 1, y = 2, z = 3 }

-- "waist, left": third of the height over the held side, and the side across the flow when it is clearly one.
function unit.place(result, case)
  if not result.place_fraction then return nil end
  local held = axis_of[case.held:sub(1, 1)]
  local words = { result.part }
  for axis = 1, 3 do
    if axis ~= held and case.flow[axis] == 0 then
      local across = result.place_fraction[axis]
      if across < 0.4 then words[2] = "left" elseif across > 0.6 then words[2] = "right" end
    end
  end
  return table.concat(words, ", ")
end

-- "Case 1: held on z-, flow along x"
function unit.title(number)
  local case = unit.cases[number]
  local along = case.flow[1] ~= 0 and "x" or case.flow[2] ~= 0 and "y" or "z"
  return string.format("Case %d: held on %s, flow along %s", number, case.held, along)
end

-- From where the held side can be seen, in front and above; distance: about, in heights; lower: by how much it looks
-- below the unit's middle, in heights.
function unit.camera(case, height, distance, lower)
  local toward, part, z = case.held == "x-" and -1 or 1, 0.63 * distance * height, -(lower or 0) * height
  return { position = { toward * part, -part, 0.72 * part + z }, focal_point = {0, 0, z}, up = {0, 0, 1} }
end

-- Lines that show a set-up in a picture of the mesh: the flow as an arrow on its way to the unit, and a frame round the
-- side that is held.
function unit.set_up(case, height, box)
  local d, tip, tail = case.flow, {}, {}
  for axis = 1, 3 do
    local edge = d[axis] > 0 and box.min[axis] - 0.08 * height or 0
    tip[axis], tail[axis] = edge, edge - 0.45 * height * d[axis]
  end
  local side = d[3] == 0 and {0, 0, 1} or {1, 0, 0}
  local function barb(sign)
    local p = {}
    for axis = 1, 3 do p[axis] = tip[axis] - 0.12 * height * d[axis] + sign * 0.07 * height * side[axis] end
    return p
  end
  local held = axis_of[case.held:sub(1, 1)]
  local u, v = held % 3 + 1, (held + 1) % 3 + 1
  local frame = {}
  for i, corner in ipairs{ {-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1} } do
    local p = {}
    p[held] = box.min[held]
    p[u] = corner[1] * 0.5 * (box.max[u] - box.min[u])
    p[v] = corner[2] * 0.5 * (box.max[v] - box.min[v])
    frame[i] = p
  end
  local blue, red = {0, 0.35, 0.75}, {0.75, 0.15, 0.1}
  return { { points = frame, label = "held side", colour = red, width = 6 },
           { points = {tail, tip}, label = "flow", colour = blue, width = 8 },
           { points = {barb(1), tip, barb(-1)}, colour = blue, width = 8 } }
end

return unit
