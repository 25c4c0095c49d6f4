# Draws load.png: gnuplot load.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set style line 2 linecolor '#D55E00' linewidth 2 pointtype 5 pointsize 1.7
set output 'load.png'.ending
set title 'From a mesh file to a world that particles can collide with'
set key outside top center horizontal
set ylabel 'million triangles a second'
set style fill solid 0.85 noborder
set grid noxtics
set boxwidth 0.3333
set yrange [0:*]
set offsets 0,0,graph 0.05,0
set xtics ('obj-20k' 0, 'ply-20k' 1, 'ascii-ply-20k' 2, 'stl-20k' 3, 'off-20k' 4, 'obj-1M' 5, 'ply-1M' 6, 'ascii-ply-1M' 7, 'stl-1M' 8, 'off-1M' 9, 'ply-5M' 10) rotate by -30 noenhanced
set xrange [-0.6:10.6]
$numbers << EOD
"obj-20k" 5.30841 2.23028
"ply-20k" 27.3561 2.2383
"ascii-ply-20k" 5.95705 2.2207
"stl-20k" 9.07052 2.18929
"off-20k" 6.21648 2.06372
"obj-1M" 4.97406 3.03704
"ply-1M" 28.4731 2.87853
"ascii-ply-1M" 5.9276 3.15184
"stl-1M" 5.43009 3.13396
"off-1M" 6.74534 2.98189
"ply-5M" 26.158 3.14253
EOD
plot $numbers using ($0+(-0.1667)):2 with boxes linestyle 1 title 'reading, one thread', \
     $numbers using ($0+(-0.1667)):2:(sprintf('%.2g',column(2))) with labels offset 0,0.6 font ',10' notitle, \
     $numbers using ($0+(0.1667)):3 with boxes linestyle 2 title 'building, all threads', \
     $numbers using ($0+(0.1667)):3:(sprintf('%.2g',column(3))) with labels offset 0,0.6 font ',10' notitle
set output
