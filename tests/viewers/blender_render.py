# SPDX-License-Identifier: GPL-3.0-or-later
"""For Blender: imports a GLB and renders it through its own camera. -- MODEL PICTURE WIDTH HEIGHT"""

import sys

import bpy
import numpy

# Blender 3.4 asks numpy for a name that numpy 1.24, beside it in Debian 12, has no more.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

model, picture, width, height = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=model)
scene = bpy.context.scene
scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = 16
scene.cycles.use_denoising = False
scene.cycles.pixel_filter_type = "BOX"
scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
scene.render.resolution_percentage = 100
scene.view_settings.view_transform = "Standard"
scene.render.image_settings.file_format = "PNG"
scene.render.image_settings.color_mode = "RGB"
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
