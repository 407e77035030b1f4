"""What stands in the made-up buildings of the worked city: types of furniture by room, for each use."""

from collections.abc import Mapping

Room = tuple[str, tuple[str, ...]]
"""A room and the types of furniture, of the built-in catalogue, that stand in it."""

ROOMS: Mapping[str, tuple[Room, ...]] = {
    "Office": (
        ("Open office", ("Bookcase tall", "Storage cabinet steel", "Lateral file 5 drawers", "Roller-shutter cabinet",
                         "Desk", "Partition screen", "Coat stand")),
        ("Archive", ("Steel shelving", "Vertical file 5 drawers", "Storage cabinet steel", "Plan chest")),
        ("Server closet", ("Server rack 42U", "Network cabinet 42U")),
        ("Kitchen", ("Refrigerator bottom freezer", "Kitchen cabinet tall", "Water dispenser")),
        ("Meeting room", ("Conference table", "Television on a stand", "Whiteboard on castors")),
    ),
    "School": (
        ("Classroom", ("Bookcase tall", "Storage cabinet steel", "Tray cabinet", "Pupil's desk",
                       "Whiteboard on castors", "Piano upright")),
        ("Science room", ("Chemical shelving", "Glassware cabinet", "Safety cabinet narrow", "Fume cupboard")),
        ("School library", ("Library shelving single-faced", "Library shelving double-faced low",
                            "Book trolley on castors")),
        ("Teachers' room", ("Storage cabinet steel", "Photocopier", "Coat stand", "Vertical file 5 drawers")),
    ),
    "Hospital": (
        ("Ward", ("Patient wardrobe", "Bedside locker on castors", "Hospital bed on castors",
                  "IV stand on castors", "Patient monitor on castors")),
        ("Pharmacy", ("Medicine cabinet", "Pharmacy drawer cabinet", "Refrigerator medicine")),
        ("Laboratory", ("Incubator floor-standing", "Freezer upright", "Wire shelving", "Gas cylinder rack")),
        ("Treatment room", ("Instrument cabinet glass", "Crash cart on castors", "Medication cart on castors")),
    ),
    "Library": (
        ("Reading room", ("Library shelving single-faced", "Periodical display rack", "Study carrel",
                          "Display stand revolving")),
        ("Stacks", ("Library shelving double-faced", "Library shelving single-faced", "Steel shelving")),
        ("Desk of loans", ("Reception counter", "Book trolley on castors", "Card index cabinet",
                           "Self-service terminal")),
    ),
    "Home": (
        ("Living room", ("Bookcase tall", "Display cabinet glass", "Wall unit", "Television on a cabinet",
                         "Sideboard")),
        ("Bedroom", ("Wardrobe", "Wardrobe 2 doors", "Chest of drawers tall", "Bookcase tall narrow")),
        ("Kitchen", ("Refrigerator bottom freezer", "Kitchen cabinet tall", "Microwave stand", "Cupboard")),
        ("Hall", ("Shoe cabinet", "Coat stand")),
    ),
}  # fmt: skip
"""Rooms by use, as the list Use of the workbook names them."""

CORRIDOR: Mapping[str, tuple[str, ...]] = {
    "Office": ("Storage cabinet steel", "Bookcase tall", "Vending machine drinks"),
    "School": ("Locker bank 3 columns", "Display board on feet", "Locker 2 doors"),
    "Hospital": ("Linen trolley on castors", "Vending machine drinks", "Storage cabinet steel"),
    "Library": ("Display stand revolving", "Library shelving single-faced", "Vending machine drinks"),
    "Home": ("Shoe cabinet", "Bookcase tall narrow", "Display cabinet glass"),
}
"""What stands beside the way out, by use: types whose width is known."""
