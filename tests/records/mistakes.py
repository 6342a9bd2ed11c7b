"""What people do wrong: each command's message and exit code are recorded, and the few that are none are answered."""

BAD_FILES = {
    "few.csv": "0 0\n1 0\n",
    "nan.csv": "0 0\n1 0\n1 nan\n0 1\n",
    "twice.csv": "0 0\n1 0\n1 0\n0 1\n",
    "bow.csv": "0 0\n2 2\n2 0\n0 2\n",
    "word.csv": "0 0\n1 0\n1 l.5\n0 1\n",
    "square.csv": "0 0\n1 0\n1 1\n0 1\n",
    "cusp.csv": "0 0\n1 0\n2 1\n1 0\n0 0\n0 2\n",
    "typo.json": '{"gallery": "elipse"}',
    "broken.json": '{"gallery": [}',
    "open.json": '{"curves": [{"type": "line", "from": [0, 0], "to": [1, 0]}]}',
    "empty.csv": "",
    "roll.csv": "time,u,psi\n0,0,0\n1,-1,2\n2,-2,4\n",
    "cell.csv": "time,u,psi\n0,0,0\n1,abc,1\n",
    "back.csv": "time,u,psi\n0,0,0\n1,-1,2\n0.5,-2,4\n",
    "lost.csv": "u,psi,contact\n0,0,0\n1,1,0\n",
    "apart.csv": "time,u,psi\n0,0,0\n1.5,-1,2\n2,-2,4\n",
    "short.csv": "time,u,psi\n0,0,0\n1,-1,2\n",
    "both.csv": "u,psi,length,turn\n0,0,0,0\n1,1,1,1\n",
    "none.csv": "a,b,c\n0,0,0\n1,1,1\n",
    "one.csv": "u,psi\n0,0\n",
    "pair.csv": "time,u_a,psi_a,u_b,psi_b\n0,0,0,0,0\n1,-1,2,1,-2\n2,-2,4,2,-4\n",
    "half.csv": "time,u_a,psi_a,u_b\n0,0,0,0\n1,-1,2,1\n",
    "world.csv": "u,psi,x\n0,0,0\n-1,2,1\n",
    "corners.json": '{"gallery": "polygon"}',
    "cut.dxf": "  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n",
    "bad.svg": "<svg><path d='M 0 0 L'/></svg>",
    "jump.csv": "time,length,turn\n" + "".join(f"{i},{0.01 * i},{0.01 * i}\n" for i in range(1, 20)) + "20,50,-90\n",
    "leap.csv": "length_a,turn_a,length_b,turn_b\n"
    + "".join(f"{0.01 * i},{0.01 * i},{0.02 * i},{0.02 * i}\n" for i in range(1, 20)) + "90,-80,1,1\n",
}

ONE_FINGER = """
locate missing.csv --reading 1,1
locate . --reading 1,1
locate few.csv --reading 1,1
locate nan.csv --reading 1,1
locate twice.csv --reading 1,1
locate bow.csv --reading 1,1
locate word.csv --reading 1,1
locate cusp.csv --reading 1,1
locate typo.json --reading 1,1
locate broken.json --reading 1,1
locate open.json --reading 1,1
locate empty.csv --reading 1,1
locate cut.dxf --reading 1,1
locate bad.svg --reading 1,1
locate part.step --reading 1,1
locate gallery:elipse --reading 1,1
locate gallery:ellipse,c=1 --reading 1,1
locate gallery:ellipse,a=-1 --reading 1,1
locate gallery:ellipse --open --reading 1,1
locate square.csv --corner-angle 59 --reading 1,1
locate square.csv --smooth 5 --reading 1,1
locate square.csv --loop 2 --reading 1,1
locate square.csv --layer Cut --reading 1,1
locate square.csv --gap 0.1 --reading 1,1
locate gallery:cam --smooth 0.1 --reading 1,1
locate gallery:cam
locate gallery:cam --reading 1
locate gallery:cam --reading 1,x
locate gallery:cam --reading 1,2,3,4
locate gallery:cam --reading nan,1
locate gallery:cam --reading 1,inf
locate gallery:cam --reading 1,1 --log roll.csv
locate gallery:cam --reading 1,1 --tolerance -1
locate gallery:cam --reading 1,1 --tolerance x
locate gallery:cam --reading 1,1 --budget 0
locate gallery:cam --reading 1,1 --budget x
locate gallery:cam --reading 1,1 --at 3
locate gallery:cam --reading 1,1 --roll 1
locate gallery:cam --reading 1,1 --prior 1,1
locate gallery:cam --reading 1,1 --robust
locate gallery:cam --reading 1,1 --facing 1
locate gallery:cam --reading 1,1 --noise contact=1 --prior 1
locate gallery:cam --reading 1,1 --noise contact=0.1,angle=0.1 --prior 99,1
locate gallery:cam --reading 1,1 --noise contact=-1
locate gallery:cam --reading 1,1 --noise slip=0.1
locate gallery:cam --reading 1,1 --noise x=1
locate gallery:cam --reading 1,1 --noise contact
locate gallery:cam --reading 1,1 --noise contact=0.1,contact=0.2
locate gallery:cam --reading 1,1 --noise angle=3deg,radius=1
locate gallery:cam --reading 1,1 --finger disk
locate gallery:cam --reading 1,1 --finger disk,r=-1
locate gallery:cam --reading 1,1 --finger disk,q=1
locate gallery:cam --reading 1,1 --finger ball,r=1
locate gallery:cam --reading 1,1 --finger square.csv
locate gallery:cam --reading 1,1 --finger corners.json
locate gallery:cam --reading 1,1 --finger gone.csv
locate gallery:cam --reading 1,1 --finger disk,r=1 --finger disk,r=1
locate gallery:cam --reading 1,1 --explain
locate gallery:cam --log roll.csv
locate gallery:cam --log gone.csv --finger disk,r=0.2
locate gallery:cam --log cell.csv --finger disk,r=0.2
locate gallery:cam --log back.csv --finger disk,r=0.2
locate gallery:cam --log lost.csv --finger disk,r=0.2
locate gallery:cam --log both.csv --finger disk,r=0.2
locate gallery:cam --log none.csv --finger disk,r=0.2
locate gallery:cam --log one.csv --finger disk,r=0.2
locate gallery:cam --log empty.csv --finger disk,r=0.2
locate gallery:cam --log world.csv --finger disk,r=0.2
locate gallery:cam --log jump.csv
locate gallery:cam --log jump.csv --noise contact=0.01,angle=0.1deg
locate gallery:cam --log roll.csv --finger disk,r=0.2 --at 9
locate gallery:cam --log roll.csv --finger disk,r=0.2 --at x
locate gallery:cam --log roll.csv --finger disk,r=0.2 --at 0.4
locate gallery:cam --log roll.csv --finger disk,r=0.2 --roll 2
locate gallery:cam --log roll.csv --finger disk,r=0.2 --roll 0
locate gallery:cam --log roll.csv --finger disk,r=0.2 --at 0
locate gallery:cam --log roll.csv --finger disk,r=0.2 --facing 1
locate gallery:exponential --reading 99,1
locate gallery:exponential --log jump.csv
locate gallery:cam --reading 1,1 --unknown
locat gallery:cam
locate
locate gallery:cam gallery:cam --reading 1,1
locate - --reading 1,1
inspect
inspect missing.csv
inspect bow.csv
inspect gallery:cam --finger ball
inspect gallery:cam --reading 1,1
advise gallery:cam
advise gallery:cam --reading 1,1 --travel 1,2
advise gallery:cam --reading 1,1 --travel x
advise gallery:cam --reading 1,1,1
teach gone.csv
teach roll.csv
teach roll.csv --finger disk,r=0.2
teach pair.csv --finger disk,r=0.2
watch gallery:cam --log roll.csv --once --finger disk,r=0.2
watch gallery:cam --noise contact=0.1 --log gone.csv --once
watch gallery:cam --every 0
simulate gallery:cam
simulate gallery:cam --finger disk,r=0.2
simulate gallery:cam --finger disk,r=0.2 --start 0
simulate gallery:cam --finger jaw --start 99 --length 1
simulate gallery:limacon --finger disk,r=1 --start 3 --length 4
simulate gallery:exponential --finger disk,r=0.1 --start 1 --length 99
"""

TWO_FINGERS = """
locate gallery:cam --reading 1,1,1
locate gallery:cam --reading 1,1,1 --reading 2,2
locate gallery:cam --reading 1,1,1 --facing x
locate gallery:cam --reading 1,x,1 --facing 1
locate gallery:cam --reading 0,0,0 --facing 1
locate gallery:circle --reading 1,1,0 --facing 1
locate gallery:cam --reading 1,1,1 --facing 1 --prior 1,1
locate gallery:cam --reading 1,1,1 --facing 1 --noise contact=0.01,angle=1deg --prior 1,1
locate gallery:cam --reading 1,1,1 --facing 1 --finger disk,r=1 --finger disk,r=1 --finger disk,r=1
locate gallery:cam --reading 1,1,1 --facing 1 --finger jaw --finger ball
locate gallery:cam --reading 1,1,1 --facing 1 --at 1
locate gallery:cam --reading 1,1,1 --facing 1 --budget 0
locate gallery:cam --reading 1,1,1 --facing 1 --tolerance -1
locate gallery:cam --log pair.csv
locate gallery:cam --log pair.csv --finger disk,r=0.2 --facing 1
locate gallery:cam --log pair.csv --finger disk,r=0.2 --at 7
locate gallery:cam --log pair.csv --finger disk,r=0.2 --roll 2
locate gallery:cam --log half.csv --finger disk,r=0.2
locate gallery:cam --log pair.csv --log roll.csv --finger disk,r=0.2
locate gallery:cam --log roll.csv --log gone.csv --finger disk,r=0.2
locate gallery:cam --log roll.csv --log apart.csv --finger disk,r=0.2
locate gallery:cam --log roll.csv --log short.csv --finger disk,r=0.2
locate gallery:cam --log roll.csv --log roll.csv --log roll.csv --finger disk,r=0.2
locate gallery:cam --log roll.csv --log jump.csv --finger disk,r=0.2
locate gallery:cam --log roll.csv --log cell.csv --finger disk,r=0.2
locate gallery:cam --log leap.csv
locate gallery:exponential --log leap.csv
locate gallery:cam --log roll.csv --log one.csv --finger disk,r=0.2
locate gallery:cam --log pair.csv --finger disk,r=0.2 --prior 1,1
locate gallery:cam --log pair.csv --finger disk,r=0.2 --robust
locate gallery:cam --log roll.csv --log roll.csv --finger disk,r=0.2
advise gallery:cam --log pair.csv --finger disk,r=0.2 --noise contact=0.01,angle=1deg
watch gallery:cam --log pair.csv --once --noise contact=0.01,angle=1deg --finger disk,r=0.2
simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 1
simulate gallery:cam --finger disk,r=0.2 --start 1 --length 1 --part-rotation 1
simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --length 0 --length 0
simulate gallery:cam --finger disk,r=0.2 --start 1 --start 4 --start 5 --length 1 --length 1
"""
