"""Sources of the methods that only some scenes of a kind use: keys of `bem.references` with what is taken from each.

Methods that every scene of a kind uses are in `CITES` of the folder of the kind. A scene yields those of its own by
`SceneModel.cited_methods`; laws of materials, oils and wear name theirs themselves (`bem.laws.Law.cites`).
"""

HEAT = {
    "lumped": {"crook1961": "mean temperature of the film", "gupta1992": "heating of the inlet"},
    "full": {
        "dowson1962": "generalised Reynolds equation",
        "cheng1965": "temperature across the film",
        "anderson1965": "coupling of film and temperature",
    },
}
MOVING_HEAT = {"jaeger1942": "moving sources of heat", "carslaw1959": "moving sources of heat"}
FLASH = {"blok1937": "partition of heat between the surfaces in contact"}
STRESSES = {"love1929": "stresses below the surface", "johnson1985": "stresses below the surface"}
POINT_FILM = {
    "brandt1990": "multilevel integration of the film's deformation",
    "venner2000": "multigrid of the film",
    "nijenbanning1994": "start of the film",
}
SHARED = {"johnson1972": "load sharing of film and asperities", "reynolds1886": "Reynolds equation"}
LINE_FILM = {"dowson1966": "elastohydrodynamic line contact"}
WAVES = {
    "greenwood1994": "waves of roughness in the film",
    "hooke2000": "waves of roughness in the film",
    "morales2011": "waves of roughness in the film",
}
MICROPITTING = {"morales2011": "micropitting"}
DANG_VAN = {"dangvan1973": "fatigue"}
STIFFNESS = {
    "ting1996": "surface of an anisotropic half-space",
    "willis1966": "contact of anisotropic bodies",
}
SURFACE_TENSION = {"hajji1978": "surface tension of the half-space", "long2013": "contact with surface tension"}
PARAMETERS = {"iso25178": "roughness parameters (Sq, Sdq, Sk and the like)"}
UNCOUPLED = {"greenwood1966": "uncoupled asperities"}
FLOW_FACTORS = {"patir1978": "flow factors", "patir1979": "shear flow factors", "almqvist2007": "homogenisation"}
COUPLING = {"dundurs1969": "friction that moves the normal gap of unlike bodies"}
FILM_DEFECT = {"kingsbury1958": "defects of the boundary film"}
GENERATED = {"hu1992": "generated roughness"}
MOMENTS = {"schreiber1996": "skewness and kurtosis of roughness"}
DESPIKED = {"hampel1974": "outliers of measured roughness"}
SEAMS_CLOSED = {"moisan2011": "measured roughness made periodic"}
ROUGH_CONTACT = {
    "nayak1971": "asperities of rough surfaces",
    "greenwood1966": "plasticity index by asperities",
    "mikic1974": "plasticity index by slope",
}
AREA_THEORIES = {
    "persson2001": "contact area beside the computed one",
    "bush1975": "contact area beside the computed one",
}
PROFILES = {
    "wang1984": "contact points of wheel and rail",
    "vollebregt2022": "wheel and rail on a tangent plane",
    "kalker1990": "spin of the contact angle",
}
ADHESIVE = {"maugis1992": "width of the adhesive zone", "anderson1965": "extrapolation of the attraction"}
ADHESIVE_SPHERE = {
    "johnson1971": "pull-off force of soft spheres (JKR)",
    "derjaguin1975": "pull-off force of stiff spheres (DMT)",
    "tabor1977": "Tabor's parameter",
}
RELAXING_IN_TIME = {"lee1960": "contact of viscoelastic bodies", "ting1966": "viscoelastic contact that shrinks"}
RELAXING_IN_MOTION = {
    "hunter1961": "steady motion of viscoelastic bodies",
    "rockafellar1976": "steady motion where the retarded part is large",
}
FROM_REST = {"kalker1971": "transient rolling"}
CURVED_RAIL = {"vollebregt2021": "contact on the curved rail", "polonsky1999": "conjugate gradients of the contact"}
LAYERED = {"burmister1945": "layered bodies", "osullivan1988": "stresses of layered bodies"}
