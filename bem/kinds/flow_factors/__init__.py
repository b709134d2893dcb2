"""Kind of scene `flow-factors`.

Flow factors of rough surfaces over separation, as deformed in their contact.
"""
