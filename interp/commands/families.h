// SPDX-License-Identifier: GPL-3.0-or-later
// The families of commands; interp/command_table.cpp puts them together.
#pragma once

#include <span>

#include "interp/command.h"

namespace tranos::interp {

std::span<const Command> PlaceCommands();
std::span<const Command> PlaceSolidCommands();
std::span<const Command> PlaceCurveCommands();  // ellipse, polygon, curve, arc tangent
std::span<const Command> PlaceWallCommands();
std::span<const Command> ChooseCommands();
std::span<const Command> CreateCommands();
std::span<const Command> TransformCommands();  // copy, move, rotate, mirror, scale
std::span<const Command> ArrayCommands();
std::span<const Command> OffsetCommands();
std::span<const Command> CutCommands();        // trim, extend, divide
std::span<const Command> CornerCommands();     // fillet, chamfer
std::span<const Command> EditCommands();       // delete, drop, modify
std::span<const Command> ConstructCommands();  // surfaces
std::span<const Command> ConstructSolidCommands();
std::span<const Command> SolidBooleanCommands();
std::span<const Command> SymmetryCommands();  // symmetric, section
std::span<const Command> PlaneCommands();
std::span<const Command> ViewCommands();        // set view, view, level
std::span<const Command> OutputCommands();      // render, export, print
std::span<const Command> PhotographCommands();  // attach, cameras
std::span<const Command> RenderPhotoCommands();
std::span<const Command> PriorCommands();
std::span<const Command> TraceCommands();
std::span<const Command> DetectCommands();
std::span<const Command> CalibrateCommands();
std::span<const Command> FacadeCommands();  // set, construct, recover
std::span<const Command> OrthophotoCommands();
std::span<const Command> HistoryCommands();
// Those that the language names and that are not carried out yet.
std::span<const Command> LaterCommands();

}  // namespace tranos::interp
